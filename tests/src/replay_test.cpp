#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "musclesim/log/recording.h"
#include "src/program.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

class ReplayCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("musclesim_replay_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void record(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"--simple", "--quiet",    "--robot", "elbow",    "--controller", "random", "--decision-interval",
                                          "0.1",      "--duration", "0.4",     "--record", "run.csv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = runProgram(arguments, folder_);
    ASSERT_EQ(result.status, 0) << result.err;
  }
  nlohmann::json replay(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"replay", "run.csv", "--json", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = runProgram(arguments, folder_);
    EXPECT_EQ(result.status, 0) << result.err;
    std::istringstream lines(result.out);
    std::string line, last;
    while (std::getline(lines, line)) last = line;
    return nlohmann::json::parse(last);
  }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

  fs::path folder_;
};

TEST_F(ReplayCommand, ReproducesItsOwnRunsBitForBit) {
  record({"--set", "elbow.forearm_kg=0.7", "--set", "muscle.slider_friction_N=0.5"});
  const auto verdict = replay({"--out", "again.csv"});
  ASSERT_EQ(verdict.at("status"), "done");
  ASSERT_TRUE(verdict.at("signals").contains("angle_elbow_deg"));
  for (const auto& [name, error] : verdict.at("signals").items()) EXPECT_EQ(error.at("largest"), 0.0) << name;
  const Recording again = readRecording((folder_ / "again.csv").string());
  EXPECT_EQ(again.time_s, readRecording((folder_ / "run.csv").string()).time_s);
}

/// The sidecar describes the replayed model, not the recorded one: with the options of the replay, the ground plane and the seed.
TEST_F(ReplayCommand, ASimulatedRecordingStatesItsOwnModel) {
  record({"--plane", "--seed", "7"});
  replay({"--out", "sim.csv", "--set", "elbow.forearm_kg=0.7", "--set", "force_law.b=1.5"});
  const RecordingInfo info = readRecording((folder_ / "sim.csv").string()).info;
  EXPECT_EQ(std::get<double>(info.robot_parameters.at("forearm_kg")), 0.7);
  EXPECT_EQ(std::get<double>(info.robot_parameters.at("force_law.b")), 1.5);
  EXPECT_TRUE(info.robot_parameters.contains("world.plane_height_mm"));
  EXPECT_EQ(info.seed, 7u);
  EXPECT_EQ(info.complete, true);
  const ProgramResult again = runProgram({"replay", "sim.csv", "--json", "--quiet"}, folder_);
  ASSERT_EQ(again.status, 0) << again.err;
  const auto verdict = nlohmann::json::parse(again.out.substr(again.out.find('{')));
  for (const auto& [name, error] : verdict.at("signals").items()) EXPECT_EQ(error.at("largest"), 0.0) << name;
}

TEST_F(ReplayCommand, WritesOverNothingThatWasNotSimulated) {
  record({});
  write("table.csv", "t,x\n0,1\n");
  EXPECT_EQ(runProgram({"replay", "run.csv", "--out", "table.csv"}, folder_).status, 2);
  write("measured.csv", "time_s,command_0,command_1\n0,0.5,0.5\n0.1,0.5,0.5\n");
  write("measured.json", R"({"format": "musclesim-recording-1", "robot": "elbow"})");
  const ProgramResult refused = runProgram({"replay", "measured.csv", "--out", "measured.csv"}, folder_);
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("would be overwritten"), std::string::npos) << refused.err;
  EXPECT_EQ(runProgram({"--simple", "--robot", "elbow", "--duration", "0.1", "--record", "measured.csv"}, folder_).status, 2);
  EXPECT_EQ(runProgram({"replay", "run.csv", "--out", "run.csv"}, folder_).status, 2) << "what is read is not written over";
  EXPECT_EQ(runProgram({"replay", "run.csv", "--out", "sim.csv", "--quiet"}, folder_).status, 0);
  EXPECT_EQ(runProgram({"replay", "run.csv", "--out", "sim.csv", "--quiet"}, folder_).status, 0) << "a simulated one may be made anew";
  write("logged.csv", "time_s,command_0,command_1\n0,0.5,0.5\n0.1,0.5,0.5\n");
  write("logged.json", R"({"format": "musclesim-recording-1", "robot": "elbow", "program": "another logger 3"})");
  const ProgramResult logged = runProgram({"replay", "run.csv", "--out", "logged.csv"}, folder_);
  EXPECT_EQ(logged.status, 2);
  EXPECT_NE(logged.err.find("did not simulate"), std::string::npos) << logged.err;
  const std::string effects = R"({"format": "musclesim-effects-1", "effects": []})";
  write("machine.json", effects);
  const ProgramResult sidecar = runProgram({"replay", "run.csv", "--out", "machine.csv"}, folder_);
  EXPECT_EQ(sidecar.status, 2);
  EXPECT_NE(sidecar.err.find("machine.json would be written over with the sidecar of machine.csv"), std::string::npos) << sidecar.err;
}

/// Other muscles need another number of internal steps, but a number that the user set stays.
TEST_F(ReplayCommand, AutomaticInternalStepsFollowTheModel) {
  record({"--muscle", "line"});
  const int of_lines = replay({}).at("substeps"), of_chains = replay({"--muscle", "chain"}).at("substeps");
  EXPECT_GT(of_chains, of_lines);
  record({"--muscle", "line", "--substeps", "7"});
  EXPECT_EQ(replay({"--muscle", "chain"}).at("substeps"), 7);
}

TEST_F(ReplayCommand, ASignalWithoutReadingsHasNoError) {
  write("run.csv", "time_s,command_0,command_1,angle_elbow_deg\n0,0.5,0.5,\n0.1,0.5,0.5,\n");
  write("run.json", R"({"format": "musclesim-recording-1", "robot": "elbow"})");
  EXPECT_TRUE(replay({}).at("signals").at("angle_elbow_deg").at("rmse").is_null());
}

TEST_F(ReplayCommand, RefusesOptionsOfPicturesWithoutOne) {
  record({});
  for (const auto& [option, value] : {std::pair("--speed", "2"), std::pair("--camera", "20,10,800"), std::pair("--substeps", "0")})
    EXPECT_EQ(runProgram({"replay", "run.csv", option, value}, folder_).status, 2) << option;
}

/// Contract: the order of arguments is free.
TEST_F(ReplayCommand, OptionsMayStandBeforeTheCommand) {
  record({});
  const ProgramResult result = runProgram({"--out", "sim.csv", "--quiet", "run.csv", "replay"}, folder_);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(fs::exists(folder_ / "sim.csv"));
  const ProgramResult unknown = runProgram({"replai", "run.csv"}, folder_);
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.err.find("did you mean replay?"), std::string::npos) << unknown.err;
  const ProgramResult other = runProgram({"replay", "run.csv", "--duration", "1"}, folder_);
  EXPECT_NE(other.err.find("--duration 1"), std::string::npos) << other.err;
}

TEST_F(ReplayCommand, NumbersInFilesThatCannotBeAreBadInput) {
  record({});
  write("model.toml", "[elbow]\nforearm_kg = -1\n");
  const ProgramResult refused = runProgram({"replay", "run.csv", "--config", "model.toml"}, folder_);
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("model.toml:2"), std::string::npos) << refused.err;
  EXPECT_EQ(runProgram({"replay", "run.csv", "--set", "elbow.forearm_kg=-1"}, folder_).status, 2);
}

TEST_F(ReplayCommand, InterruptedVideosAreWhole) {
  if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  const ProgramResult recorded =
      runProgram({"--simple", "--quiet", "--robot", "elbow", "--controller", "random", "--duration", "60", "--record", "run.csv"}, folder_);
  ASSERT_EQ(recorded.status, 0) << recorded.err;
  const ProgramResult result =
      interruptProgram({"replay", "run.csv", "--video", "cut.mp4", "--picture-size", "1024x768"}, SIGINT, "cut.mp4", 1, folder_);
  if (result.err.find("cannot draw pictures") != std::string::npos || result.err.find("need OSMesa") != std::string::npos)
    GTEST_SKIP() << result.err;
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_NE(result.err.find("interrupted"), std::string::npos) << result.err;
  std::ifstream video(folder_ / "cut.mp4");
  const std::string bytes{std::istreambuf_iterator<char>(video), {}};
  EXPECT_NE(bytes.find("moov"), std::string::npos) << "the index that players need";
}

TEST_F(ReplayCommand, ShowsTheGapOfAnotherModel) {
  record({});
  const auto verdict = replay({"--set", "elbow.forearm_kg=0.7"});
  EXPECT_GT(verdict.at("signals").at("angle_elbow_deg").at("rmse"), 0.1);
}

TEST_F(ReplayCommand, PrintsATableForPeople) {
  record({});
  const ProgramResult result = runProgram({"replay", "run.csv"}, folder_);
  EXPECT_EQ(result.status, 0);
  for (const char* word : {"RMSE", "angle_elbow_deg", "length_1_mm", "deg"}) EXPECT_NE(result.out.find(word), std::string::npos) << word;
}

std::string beginOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string begin(4, ' ');
  stream.read(begin.data(), 4);
  return begin;
}

TEST_F(ReplayCommand, DrawsTheFigureOfTheGap) {
  record({});
  replay({"--out", "sim.csv"});
  EXPECT_EQ(beginOf(folder_ / "sim.svg"), "<svg");
  const auto verdict = replay({"--figure", "figures/gap.svg"});
  EXPECT_EQ(verdict.at("figure"), "figures/gap.svg");
  std::ifstream stream(folder_ / "figures/gap.svg");
  const std::string svg{std::istreambuf_iterator<char>(stream), {}};
  for (const char* part : {"angle_elbow_deg: residual", "length_1_mm over pressure_1", "noise band"})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  EXPECT_EQ(runProgram({"replay", "run.csv", "--figure", "gap.pdf"}, folder_).status, 2);
}

TEST_F(ReplayCommand, DrawsFiguresAsPng) {
  if (std::system("command -v rsvg-convert >/dev/null 2>&1") != 0) GTEST_SKIP() << "rsvg-convert is not installed";
  record({});
  replay({"--figure", "gap.png"});
  EXPECT_EQ(beginOf(folder_ / "gap.png"), "\x89PNG");
  EXPECT_EQ(runProgram({"figure", "run.csv", "-o", "run.png"}, folder_).status, 0);
  EXPECT_EQ(beginOf(folder_ / "run.png"), "\x89PNG");
  for (const auto& file : fs::directory_iterator(folder_)) EXPECT_EQ(file.path().string().find("drawing"), std::string::npos) << file;
}

TEST_F(ReplayCommand, WindowsNeedADisplay) {
  record({});
  unsetenv("DISPLAY");
  const ProgramResult result = runProgram({"replay", "run.csv", "--window"}, folder_);
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(runProgram({"replay", "run.csv", "--window-log", "log.jsonl"}, folder_).status, 2) << "needs --window";
}

TEST_F(ReplayCommand, RefusesBadInput) {
  auto expectRefused = [&](const std::vector<std::string>& arguments, int status, const std::string& word) {
    const ProgramResult result = runProgram(arguments, folder_);
    EXPECT_EQ(result.status, status) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << word << " is missing in: " << result.err;
  };
  expectRefused({"replay"}, 2, "recording");
  expectRefused({"replay", "missing.csv"}, 5, "missing.csv");
  write("rig.json", R"({"format": "musclesim-recording-1", "robot": "rig"})");
  write("rig.csv", "time_s,command_0,length_0_mm\n0,0.5,200\n0.01,1.5,200\n");
  expectRefused({"replay", "rig.csv"}, 3, "rig.csv:3:");
  write("rig.csv", "time_s,command_0,command_1,length_0_mm\n0,0.5,0.5,200\n0.01,0.5,0.5,200\n");
  expectRefused({"replay", "rig.csv"}, 3, "command");
  write("rig.csv", "time_s,command_0,length_0_mm\n0,0.5,200\n0.01,0.5,200\n");
  expectRefused({"replay", "rig.csv", "--set", "rig.lod_kg=2"}, 2, "rig.load_kg");
  expectRefused({"replay", "rig.csv", "--out", "rig.json/x.csv"}, 5, "rig.json");
  expectRefused({"replay", "rig.csv", "--out", "x.txt"}, 2, "recording = x.txt: must end in .csv");
  write("rig.json", R"({"format": "musclesim-recording-1", "robot": "rigg"})");
  expectRefused({"replay", "rig.csv"}, 3, "rig.json: there is no robot \"rigg\"");
  expectRefused({"replay", "rig.csv", "--robot", "elboww"}, 2, "elboww");
}

}  // namespace
}  // namespace musclesim
