/// `musclesim rerun`: a run is repeated from its folder alone.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "src/program.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class RerunCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("musclesim_rerun_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  ProgramResult program(const std::vector<std::string>& arguments) { return runProgram(arguments, folder_); }
  /// A run in "a", which is moved to "b" and whose input files are then removed.
  void runAndMove(std::vector<std::string> arguments, int status = 0, const std::vector<std::string>& inputs = {}) {
    for (const char* more : {"--simple", "--quiet", "--out", "a"}) arguments.emplace_back(more);
    const ProgramResult result = program(arguments);
    ASSERT_EQ(result.status, status) << result.err;
    fs::rename(folder_ / "a", folder_ / "b");
    for (const std::string& input : inputs) fs::remove(folder_ / input);
  }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  std::string content(const std::string& name) {
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }
  template <class Change>
  void changeSidecar(Change change) {
    json sidecar = json::parse(content("b/run.json"));
    change(sidecar);
    write("b/run.json", sidecar.dump());
  }
  void expectSame(const ProgramResult& result, const std::string& words = "the same") {
    EXPECT_EQ(result.status, 0) << result.err << result.out;
    EXPECT_NE(result.out.find(words), std::string::npos) << result.out;
  }
  void expect(const ProgramResult& result, int status, const std::vector<std::string>& words) {
    EXPECT_EQ(result.status, status) << result.err << result.out;
    for (const std::string& word : words)
      EXPECT_NE((result.out + result.err).find(word), std::string::npos) << word << ": " << result.out << result.err;
  }

  /// A run with every kind of input file that a folder keeps.
  void runWithFiles() {
    ASSERT_EQ(program({"robot", "new", "lever"}).status, 0);
    write("settings.toml", "[lever]\n\n[muscle]\nbead_mass_g = 9\n");
    write("effects.json", R"({"format": "musclesim-effects-1", "effects": [{"id": "valve_lag", "component": "all",
      "parameters": {"fill_time_constant_s": 0.08}}]})");
    write("commands.csv", "time_s,command_0,command_1\n0,0.1,0.2\n0.2,0.5,0.1\n0.4,0.3,0.3\n");
    runAndMove(
        {"--robot=lever.toml", "--config", "settings.toml", "--effects", "effects.json", "--commands", "commands.csv", "--duration", "0.5"},
        0, {"lever.toml", "settings.toml", "effects.json", "commands.csv"});
  }

  fs::path folder_;
};

TEST_F(RerunCommand, RepeatsARunWithoutItsInputFilesInAnotherFolder) {
  runWithFiles();
  const ProgramResult result = program({"rerun", "b", "--json", "--out", "again"});
  expectSame(result);
  EXPECT_EQ(json::parse(result.out.substr(result.out.find('{'))).at("status"), "same");
  EXPECT_EQ(content("again/run.csv"), content("b/run.csv"));
}

TEST_F(RerunCommand, SaysWhichInputHasChanged) {
  runWithFiles();
  const fs::path effects = folder_ / "b/run_inputs/effects/effects.json";
  std::string text = content("b/run_inputs/effects/effects.json");
  text.replace(text.find("0.08"), 4, "0.12");
  std::ofstream(effects) << text;
  expect(program({"rerun", "b"}), 3, {"other bytes, from line", "active_effects", "effects.json is not the file of the run"});
  const ProgramResult result = program({"rerun", "b"});
  EXPECT_EQ(result.out.find("lever.toml"), std::string::npos) << result.out;
}

TEST_F(RerunCommand, SaysThatARobotFileHasChanged) {
  runWithFiles();
  std::ofstream(folder_ / "b/run_inputs/robot/lever.toml", std::ios::app) << "# a remark\n";
  expect(program({"rerun", "b"}), 0, {"the same", "lever.toml is not the file of the run"});
}

TEST_F(RerunCommand, SaysWhichNumberAndWhichProgramDiffer) {
  runAndMove({"--robot", "elbow", "--duration", "0.2", "--seed", "7"});
  changeSidecar([](json& sidecar) {
    sidecar["seed"] = 8;
    sidecar["step_s"] = 0.02;
    sidecar["program"] = "musclesim 0.0.1";
    sidecar["run"]["build"]["program"] = "0123";
  });
  expect(program({"rerun", "b"}), 0,
         {"the same", "seed: 8 was recorded, 7", "step_s: 0.02", "musclesim 0.0.1 made the recording", "build of program: 0123"});
}

TEST_F(RerunCommand, AChangedTableIsFound) {
  runAndMove({"--robot", "elbow", "--duration", "0.2"});
  std::string table = content("b/run.csv");
  const std::size_t digit = table.find_last_of("12345678");
  table[digit] = table[digit] == '1' ? '2' : '1';
  write("b/run.csv", table);
  expect(program({"rerun", "b"}), 3, {"other bytes, from line 22 on", "nothing that the folder names"});
}

TEST_F(RerunCommand, RepeatsWhatDivergedOrWasInterruptedOrKilled) {
  runAndMove({"--robot", "elbow", "--controller", "random", "--decision-interval", "0.05", "--substeps", "1", "--step", "0.05",
              "--duration", "20"},
             4);
  expectSame(program({"rerun", "b"}));
  for (const int signal : {SIGINT, SIGKILL}) {
    fs::remove_all(folder_ / "a");
    interruptProgram({"--simple", "--robot", "elbow", "--out", "a", "--quiet"}, signal, "a/run.csv", 20000, folder_);
    expectSame(program({"rerun", "a"}));
  }
}

TEST_F(RerunCommand, RepeatsTheCommandsOfARunByHand) {
  runAndMove({"--robot", "elbow", "--duration", "0.5"});
  changeSidecar([](json& sidecar) {  // as if a user had moved the muscles, and the controller had not
    sidecar["by_hand_s"] = json::array({{0.0, 0.5}});
    sidecar["run"]["arguments"] = {"--robot", "elbow", "--controller", "hold"};
  });
  const ProgramResult by_hand = program({"rerun", "b"});
  expectSame(by_hand, "the same bits in");
  EXPECT_NE(by_hand.err.find("only the commands are repeated: the user controlled muscles by hand"), std::string::npos) << by_hand.err;
  changeSidecar([](json& sidecar) { sidecar["robot_parameters"]["forearm_kg"] = 0.7; });
  expect(program({"rerun", "b"}), 3, {"other bits in", "angle_elbow_deg"});
}

TEST_F(RerunCommand, ARecordingWithoutItsOriginIsReplayed) {
  runAndMove({"--duration", "0.5", "--muscles", "3"});
  changeSidecar([](json& sidecar) { sidecar.erase("run"); });
  expect(program({"rerun", "b/run.csv"}), 0, {"the same bits in", "not repeated: target_y_mm, activity"});
}

TEST_F(RerunCommand, ReadsNoFileButTheCopies) {
  runWithFiles();
  const json good = json::parse(content("b/run.json"));
  write("outside.toml", content("b/run_inputs/robot/lever.toml"));
  const auto refused = [&](const std::string& copy, const std::string& words) {
    changeSidecar([&](json& sidecar) { sidecar = good, sidecar["run"]["files"][0]["copy"] = copy; });
    expect(program({"rerun", "b"}), 3, {"run.json", words});
  };
  refused("../outside.toml", "must lie within the folder");
  refused((folder_ / "outside.toml").string(), "must lie within the folder");
  refused("run_inputs/robot/absent.toml", "has gone");
  fs::create_symlink(folder_ / "outside.toml", folder_ / "b/run_inputs/link.toml");
  refused("run_inputs/link.toml", "no link that leads elsewhere");
  changeSidecar([&](json& sidecar) { sidecar = good, sidecar["run"]["arguments"] = {"--robot", "outside.toml"}; });
  expect(program({"rerun", "b"}), 3, {"the folder has no copy of --robot outside.toml"});
  changeSidecar([&](json& sidecar) { sidecar = good, sidecar["run"]["arguments"].push_back("--unheard-of"); });
  expect(program({"rerun", "b"}), 3, {"does not understand the arguments"});
  changeSidecar([&](json& sidecar) { sidecar = good, sidecar["run"]["files"] = 3; });
  expect(program({"rerun", "b"}), 3, {"the member \"run\" must be as this program writes it"});
}

TEST_F(RerunCommand, RunsNoPluginUnasked) {
  runAndMove({"--plugin", MUSCLESIM_PLUGIN, "--robot", "elbow", "--duration", "0.1"});
  expect(program({"rerun", "b"}), 2, {"are code", MUSCLESIM_PLUGIN});
  expectSame(program({"rerun", "b", "--plugin", MUSCLESIM_PLUGIN}));
}

TEST_F(RerunCommand, RefusesFoldersWithoutARun) {
  expect(program({"rerun", "."}), 3, {"has no run.csv"});
  expect(program({"rerun", "absent.csv"}), 5, {"absent.csv"});
}

}  // namespace
}  // namespace musclesim
