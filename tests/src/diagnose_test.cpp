// musclesim diagnose: refusals and their exit statuses.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "musclesim/base/file.h"
#include "src/program.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

class DiagnoseCommand : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  /// Writes a recording of the rig with this number of rows; lengths are multiplied by `unit`.
  void write(const std::string& stem, int rows, double unit, const std::string& robot = "rig") const {
    std::ofstream(folder_ / (stem + ".json")) << fmt::format(R"({{"format": "musclesim-recording-1", "robot": "{}"}})", robot);
    std::ofstream file(folder_ / (stem + ".csv"));
    file << "time_s,command_0,length_0_mm\n";
    for (int row = 0; row < rows; ++row)
      file << fmt::format("{:.2f},{},{:.7f}\n", 0.01 * row, row < rows / 2 ? 0.3 : 0.5,
                          unit * (row < rows / 2 ? 240 + 0.01 * (row % 7) : 220.0));
  }
  ProgramResult diagnose(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"diagnose", "--quiet"});
    return runProgram(arguments, folder_);
  }
  /// plant1.csv and plant2.csv: a payload recorded at almost a single pressure. The recordings themselves do not name it.
  void recordPayload() const {
    const std::string sidecar = R"({"format": "musclesim-recording-1", "robot": "rig", "robot_parameters": {"load_kg": 1.5}})";
    std::ofstream(folder_ / "payload.json")
        << R"({"format": "musclesim-effects-1", "effects": [{"id": "payload", "component": "hand", "parameters": {"mass_kg": 0.2}}]})";
    for (const int number : {1, 2}) {
      std::ofstream(folder_ / fmt::format("plan{}.json", number)) << sidecar;
      std::ofstream plan(folder_ / fmt::format("plan{}.csv", number));
      plan << "time_s,command_0\n";
      for (int row = 0; row < 100; ++row) plan << fmt::format("{:.2f},{}\n", 0.01 * row, 0.29 + 0.01 * number + (row < 50 ? 0 : 0.02));
      plan.close();
      const std::string of_plant = fmt::format("plant{}", number);
      ASSERT_EQ(runProgram({"replay", fmt::format("plan{}.csv", number), "--effects", "payload.json", "--set", "sensor.length_noise_mm=0.3",
                            "--seed", std::to_string(number), "--out", of_plant + ".csv", "--quiet"},
                           folder_)
                    .status,
                0);
      std::ofstream(folder_ / (of_plant + ".json")) << sidecar;
    }
  }
  const fs::path folder_ = fs::temp_directory_path() / ("musclesim_diagnose_test_" + std::to_string(getpid()));
};

TEST_F(DiagnoseCommand, BadRecordingsAreBadFiles) {
  write("few", 12, 1);
  write("metres", 60, 1e-3);
  write("other", 60, 1, "elbow");
  write("good", 60, 1);
  for (const auto& [file, words] : {std::pair("few.csv", "hold fewer than 10 numbers"), std::pair("metres.csv", "a thousand times")}) {
    const ProgramResult result = diagnose({file});
    EXPECT_EQ(result.status, 3) << file << ": " << result.err;
    EXPECT_TRUE(contains(result.err, words) && contains(result.err, file)) << result.err;
  }
  write("unknown", 60, 1, "rigg");
  for (const auto& [file, words] :
       {std::pair("other.csv", "no complete command_1"), std::pair("unknown.csv", "unknown.json: there is no robot")}) {
    const ProgramResult result = diagnose({file});
    EXPECT_EQ(result.status, 3) << file << ": " << result.err;
    EXPECT_TRUE(contains(result.err, words)) << result.err;
  }
  EXPECT_EQ(diagnose({"good.csv", "other.csv"}).status, 3);
  EXPECT_EQ(diagnose({"good.csv", "good.csv"}).status, 3);
}

TEST_F(DiagnoseCommand, RecordingsBehindAListAreNoPartOfIt) {
  write("good", 60, 1);
  for (const auto& [option, value] : {std::pair("--ignore-columns", "activity"), std::pair("--exclude", "creep,leak"),
                                      std::pair("--candidates", "leak"), std::pair("--tune", "rig.load_kg")}) {
    const ProgramResult result = diagnose({option, value, "missing.csv", "good.csv"});
    EXPECT_EQ(result.status, 5) << option << ": " << result.err;
    EXPECT_TRUE(contains(result.err, "missing.csv")) << option << ": " << result.err;
  }
}

TEST_F(DiagnoseCommand, WhatIsReadIsNotWrittenOver) {
  fs::create_directories(folder_ / "out");
  write("out/next", 60, 1);
  std::ofstream(folder_ / "out" / "nominal.toml") << "[muscle]\nslider_friction_N = 0.9\n";
  write("good", 60, 1);
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"good.csv", "out/next.csv"}, {"good.csv", "--config", "out/nominal.toml"}}) {
    std::vector<std::string> arguments = options;
    arguments.insert(arguments.end(), {"--out", "out"});
    const ProgramResult result = diagnose(arguments);
    EXPECT_EQ(result.status, 2) << options[1];
    EXPECT_TRUE(contains(result.err, "is an input and would be overwritten")) << result.err;
  }
  EXPECT_TRUE(fs::exists(folder_ / "out" / "next.csv") && fs::exists(folder_ / "out" / "nominal.toml"));
}

TEST_F(DiagnoseCommand, TheProposedScheduleCanBeReplayed) {
  recordPayload();
  fs::create_directories(folder_ / "out");
  const fs::path half_written = folder_ / "out" / "report.html.0123456789abcdef.tmp";
  std::ofstream(half_written) << "of a diagnosis that was killed";
  const ProgramResult result = diagnose(
      {"plant1.csv", "plant2.csv", "--candidates", "payload,force_gain", "--ignore-columns", "force_0_N,pressure_0", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_FALSE(fs::exists(half_written));
  EXPECT_TRUE(contains(result.out, "record next.csv")) << result.out;
  EXPECT_EQ(runProgram({"replay", "out/next.csv", "--quiet", "--out", "predicted.csv"}, folder_).status, 0);
  std::stringstream of_prediction;
  of_prediction << std::ifstream(folder_ / "predicted.json").rdbuf();
  EXPECT_TRUE(contains(of_prediction.str(), R"("load_kg": 1.5)")) << of_prediction.str();
}

TEST_F(DiagnoseCommand, WrongOptionsAreUsageErrors) {
  write("good", 60, 1);
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--candidates", "nonsense"},
                                                  {"--tune", "muscle.model"},
                                                  {"--tune", "rig.lod_kg"},
                                                  {"--tune", "rig.load_kg,rig.load_kg"},
                                                  {"--max-effects", "0"},
                                                  {"--jobs", "0"}}) {
    std::vector<std::string> arguments = options;
    arguments.push_back("good.csv");
    EXPECT_EQ(diagnose(arguments).status, 2) << options[0] << " " << options[1];
  }
}

/// diagnosis.json and effects.json without the time that the diagnosis took.
std::string answerIn(const fs::path& folder) {
  const auto text = [&](const char* file) { return readTextFile((folder / file).string(), std::size_t{1} << 26); };
  auto json = nlohmann::json::parse(text("diagnosis.json"));
  json["cost"].erase("wall_s");
  return json.dump() + text("effects.json");
}

/// Killed when a third and when two thirds of the simulations were kept.
TEST_F(DiagnoseCommand, GoesOnAfterBeingKilled) {
  recordPayload();
  std::vector<std::string> arguments = {"plant1.csv",       "plant2.csv",           "--candidates", "payload,force_gain",
                                        "--ignore-columns", "force_0_N,pressure_0", "--out",        "out"};
  ASSERT_EQ(diagnose(arguments).status, 0);
  const std::string answer = answerIn(folder_ / "out");
  EXPECT_FALSE(fs::exists(folder_ / "out" / "unfinished.dat"));
  arguments.back() = "cut";
  std::vector<std::string> whole = arguments;
  whole.insert(whole.begin(), "diagnose");
  ASSERT_EQ(interruptProgram(whole, SIGKILL, "cut/unfinished.dat", 50'000, folder_).status, 128 + SIGKILL);
  EXPECT_FALSE(fs::exists(folder_ / "cut" / "diagnosis.json"));
  whole.push_back("--resume");
  const auto size = fs::file_size(folder_ / "cut" / "unfinished.dat");
  EXPECT_EQ(interruptProgram(whole, SIGKILL, "cut/unfinished.dat", size + 50'000, folder_).status, 128 + SIGKILL);
  const ProgramResult result = runProgram(whole, folder_);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "goes on from ")) << result.err;
  EXPECT_EQ(answerIn(folder_ / "cut"), answer);
  EXPECT_FALSE(fs::exists(folder_ / "cut" / "unfinished.dat"));
}

TEST_F(DiagnoseCommand, AnUnfinishedDiagnosisOfSomethingElseIsRefusedByName) {
  recordPayload();
  const std::vector<std::string> common = {"diagnose", "plant1.csv", "plant2.csv", "--out", "cut", "--candidates", "payload,force_gain"};
  ASSERT_EQ(interruptProgram(common, SIGKILL, "cut/unfinished.dat", 50'000, folder_).status, 128 + SIGKILL);
  const auto resumed = [&](const std::vector<std::string>& more, const std::string& words) {
    std::vector<std::string> arguments = common;
    arguments.push_back("--resume");
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = runProgram(arguments, folder_);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_TRUE(contains(result.err, words)) << result.err;
  };
  resumed({"--max-effects", "2"}, "options.--max-effects was 4, is 2");
  resumed({"--exclude", "payload"}, "options.--exclude was \"\", is \"payload\"");
  resumed({"--set", "rig.load_kg=1.6"}, "model.robot_parameters.load_kg was 1.5, is 1.6");
  const std::string text = readTextFile((folder_ / "plant2.csv").string(), std::size_t{1} << 20);
  std::ofstream(folder_ / "plant2.csv") << text.substr(0, text.rfind('\n', text.size() - 2) + 1);
  resumed({}, "recordings.2 is another");
  std::ofstream(folder_ / "plant2.csv") << text;
  // A file that is damaged in its middle loses what follows.
  std::fstream file(folder_ / "cut" / "unfinished.dat", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(30'000);
  file << "damaged";
  file.close();
  std::vector<std::string> arguments = common;
  arguments.insert(arguments.end(), {"--resume", "--jobs", "1"});
  const ProgramResult result = runProgram(arguments, folder_);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "are no whole simulation and are not used")) << result.err;
}

}  // namespace
}  // namespace musclesim
