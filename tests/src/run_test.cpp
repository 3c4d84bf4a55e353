#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "musclesim/log/recording.h"
#include "src/program.h"
#include "support/support.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// An empty folder that is removed at the end.
class RunCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("musclesim_run_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  ProgramResult run(std::vector<std::string> arguments) { return runProgram(arguments, folder_); }
  /// A short run that costs little: the rig under constant pressure.
  ProgramResult runRig(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"--simple", "--robot", "rig", "--controller", "hold", "--duration", "0.2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  void expectRefused(const std::vector<std::string>& arguments, int status, const std::vector<std::string>& words) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, status) << result.err;
    EXPECT_EQ(result.out, "") << "only results go to standard output";
    for (const auto& word : words) EXPECT_NE(result.err.find(word), std::string::npos) << word << " is missing in: " << result.err;
  }

  fs::path folder_;
};

TEST_F(RunCommand, WritesLogAndFigureAndNamesThemLast) {
  const ProgramResult result = run({"--simple", "--physics", "original", "--duration", "0.1", "--muscles", "2"});
  ASSERT_EQ(result.status, 0) << result.err;
  std::istringstream lines(result.out);
  std::string word, log, figure;
  lines >> word >> log >> word >> figure;
  ASSERT_TRUE(fs::exists(folder_ / log)) << result.out;
  ASSERT_TRUE(fs::exists(folder_ / figure)) << result.out;
  const Recording recording = readRecording((folder_ / log).string());
  EXPECT_EQ(recording.info.robot, "arm");
  EXPECT_EQ(recording.info.physics, "original");
  EXPECT_EQ(recording.time_s.size(), 11u);
  for (const char* name : {"command_1", "pressure_0", "force_1_N", "length_0_mm", "angle_elbow_deg", "angle_wrist_deg", "hand_y_mm",
                           "target_y_mm", "activity"})
    EXPECT_NE(recording.find(name), nullptr) << name;
  const auto sidecar = nlohmann::json::parse(contentOf(sidecarPath((folder_ / log).string())));
  EXPECT_EQ(sidecar.at("complete"), true);
  EXPECT_EQ(sidecar.at("seed"), 1);
  EXPECT_EQ(sidecar.at("verdict").at("status"), "done");
  EXPECT_EQ(sidecar.at("parameters").at("muscle.bead_mass_g"), 10);
}

TEST_F(RunCommand, SameSeedGivesTheSameBytes) {
  for (const char* name : {"a", "b"})
    ASSERT_EQ(run({"--simple", "--seed", "3", "--physics", "original", "--duration", "0.3", "--muscles", "3", "--out", name}).status, 0);
  ASSERT_EQ(run({"--simple", "--seed", "4", "--physics", "original", "--duration", "0.3", "--muscles", "3", "--out", "c"}).status, 0);
  const std::string first = contentOf(folder_ / "a" / "run.csv");
  EXPECT_GT(first.size(), 1000u);
  EXPECT_EQ(first, contentOf(folder_ / "b" / "run.csv"));
  EXPECT_NE(first, contentOf(folder_ / "c" / "run.csv"));
}

TEST_F(RunCommand, ArgumentsInAnyOrderWithAndWithoutTheSubcommandsName) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", "--robot", "rig", "--controller", "hold", "--duration", "0.05", "--simple"},
        {"--duration", "0.05", "--simple", "run", "--controller", "hold", "--robot", "rig"},
        {"--controller", "hold", "--simple", "--duration", "0.05", "--robot", "rig"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
  }
}

TEST_F(RunCommand, VerboseListsPrimitivesAndActuators) {
  const ProgramResult result = run({"--verbose", "--step", "0.001", "--simple", "--physics", "original", "--duration", "0.002"});
  ASSERT_EQ(result.status, 0) << result.err;
  for (const char* word : {"humerus", "scapula", "pollex", "actuator muscle_9", "purple"})
    EXPECT_NE(result.out.find(word), std::string::npos) << word;
}

TEST_F(RunCommand, StepIsTheLoggingStepAndRecordIntervalThinsIt) {
  ASSERT_EQ(runRig({"--step", "0.002", "--record", "fine.csv"}).status, 0);
  EXPECT_EQ(readRecording((folder_ / "fine.csv").string()).time_s.size(), 101u);
  ASSERT_EQ(runRig({"--record-interval", "0.05", "--record", "coarse.csv"}).status, 0);
  EXPECT_EQ(readRecording((folder_ / "coarse.csv").string()).time_s.size(), 5u);
}

TEST_F(RunCommand, CommandsThatChangeBetweenRowsAreWarnedOf) {
  const auto random = [&](const char* interval_s) {
    return runProgram({"--simple", "--robot", "rig", "--controller", "random", "--decision-interval", "0.05", "--duration", "0.2",
                       "--record-interval", interval_s, "--record", "random.csv"},
                      folder_);
  };
  EXPECT_FALSE(contains(random("0.05").err, "commands change between them"));
  EXPECT_TRUE(contains(random("0.1").err, "the rows are recorded 0.1 s apart and commands change between them"));
}

TEST_F(RunCommand, PrintConfigIsAcceptedByConfig) {
  const ProgramResult printed = runRig({"--print-config", "--set", "rig.load_kg=3.5"});
  ASSERT_EQ(printed.status, 0) << printed.err;
  EXPECT_NE(printed.out.find("load_kg = 3.5"), std::string::npos) << printed.out;
  std::ofstream(folder_ / "model.toml") << printed.out;
  const ProgramResult again = runRig({"--print-config", "--config", "model.toml"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.out, printed.out);
}

TEST_F(RunCommand, JsonVerdictIsTheLastLine) {
  const ProgramResult result = runRig({"--json", "--quiet"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  std::istringstream lines(result.out);
  std::string line, last;
  while (std::getline(lines, line)) last = line;
  EXPECT_EQ(nlohmann::json::parse(last).at("status"), "done");
}

TEST_F(RunCommand, InterruptedRunsAreReadableAndNotComplete) {
  const ProgramResult result =
      interruptProgram({"--simple", "--robot", "elbow", "--controller", "hold", "--duration", "1000", "--record", "cut.csv"}, SIGINT,
                       "cut.csv", 2000, folder_);
  EXPECT_EQ(result.status, 130) << result.err;
  const Recording recording = readRecording((folder_ / "cut.csv").string());
  EXPECT_GT(recording.time_s.size(), 5u);
  EXPECT_EQ(nlohmann::json::parse(contentOf(folder_ / "cut.json")).at("complete"), false);
}

/// The process that writes the video gets the signal too.
TEST_F(RunCommand, InterruptedVideosAreWhole) {
  if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  const ProgramResult result = interruptProgram({"--robot", "elbow", "--controller", "hold", "--duration", "1000", "--record", "cut.csv",
                                                 "--video", "cut.mp4", "--picture-size", "160x120"},
                                                SIGINT, "cut.csv", 2000, folder_);
  if (result.err.find("cannot draw pictures") != std::string::npos || result.err.find("need OSMesa") != std::string::npos)
    GTEST_SKIP() << result.err;
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_NE(result.err.find("interrupted"), std::string::npos) << result.err;
  EXPECT_GT(readRecording((folder_ / "cut.csv").string()).time_s.size(), 5u);
  EXPECT_EQ(nlohmann::json::parse(contentOf(folder_ / "cut.json")).at("complete"), false);
  EXPECT_NE(contentOf(folder_ / "cut.mp4").find("moov"), std::string::npos) << "the index that players need";
}

TEST_F(RunCommand, DivergenceKeepsTheRecordingAndExitsWith4) {
  const ProgramResult result = run({"--simple", "--robot", "elbow", "--controller", "random", "--decision-interval", "0.05", "--substeps",
                                    "1", "--step", "0.05", "--duration", "20", "--record", "torn.csv"});
  EXPECT_EQ(result.status, 4) << result.err;
  EXPECT_NE(result.err.find("diverged at"), std::string::npos) << result.err;
  EXPECT_GE(readRecording((folder_ / "torn.csv").string()).time_s.size(), 1u);
  const auto sidecar = nlohmann::json::parse(contentOf(folder_ / "torn.json"));
  EXPECT_EQ(sidecar.at("complete"), false);
  EXPECT_EQ(sidecar.at("verdict").at("status"), "diverged");
}

TEST_F(RunCommand, WithoutADisplayNamesTheWayOut) {
  expectRefused({}, 2, {"--simple", "--screenshot"});
}

TEST_F(RunCommand, PicturesAreDrawnWithoutADisplayAndChangeNothing) {
  ASSERT_EQ(runRig({"--out", "plain"}).status, 0);
  const ProgramResult drawn = run({"--robot", "rig", "--controller", "hold", "--duration", "0.2", "--out", "drawn", "--screenshot",
                                   "pictures/rig.png", "--video", "pictures/rig.mp4", "--picture-size", "160x120"});
  if (drawn.err.find("cannot draw pictures") != std::string::npos || drawn.err.find("need OSMesa") != std::string::npos)
    GTEST_SKIP() << drawn.err;
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_GT(fs::file_size(folder_ / "pictures" / "rig.png"), 300u);
  EXPECT_TRUE(fs::exists(folder_ / "pictures" / "rig.mp4") || fs::exists(folder_ / "pictures" / "rig-frames" / "000007.png"));
  EXPECT_EQ(contentOf(folder_ / "plain" / "run.csv"), contentOf(folder_ / "drawn" / "run.csv"));
  const ProgramResult replayed =
      run({"replay", "plain/run.csv", "--screenshot", "again.png", "--picture-size", "160x120", "--camera", "20,10,800"});
  EXPECT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_GT(fs::file_size(folder_ / "again.png"), 300u);
}

TEST_F(RunCommand, ADivergenceWhileSettlingIsNoneOfTheRun) {
  const ProgramResult result = run({"--simple", "--robot", "elbow", "--controller", "hold", "--duration", "2", "--step", "0.2",
                                    "--substeps", "1", "--stepper", "quick", "--json"});
  EXPECT_EQ(result.status, 4) << result.err;
  EXPECT_NE(result.err.find("while it settled"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("last rows of the recording"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("\"simulated_s\":0.0"), std::string::npos) << result.out;
}

TEST_F(RunCommand, RefusesPicturesThatCannotBe) {
  expectRefused({"--screenshot", "a.jpg", "--robot", "rig", "--controller", "hold"}, 2, {"screenshot"});
  expectRefused({"--video", "a.avi", "--robot", "rig", "--controller", "hold"}, 2, {"video"});
  for (const std::vector<std::string>& view : {std::vector<std::string>{"--camera", "20,10,800"}, {"--picture-size", "160x120"}})
    expectRefused({"--simple", "--robot", "rig", view[0], view[1]}, 2, {"--simple opens no window"});
  expectRefused({"--screenshot", "a.png", "--picture-size", "5x5", "--robot", "rig", "--controller", "hold"}, 2, {"5", "16"});
  expectRefused({"--video", "a.mp4", "--speed", "-1", "--robot", "rig", "--controller", "hold"}, 2, {"speed"});
}

TEST_F(RunCommand, RefusesOptionsOfAWindowWithoutOne) {
  const std::vector<std::string> rig = {"--robot", "rig", "--controller", "hold", "--duration", "0.1"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), rig.begin(), rig.end());
    return more;
  };
  expectRefused(with({"--simple", "--window-log", "w.jsonl"}), 2, {"--window-log", "--simple opens no window"});
  expectRefused(with({"--screenshot", "a.png", "--window-log", "w.jsonl"}), 2, {"--window-log", "--screenshot"});
  expectRefused(with({"--simple", "--speed", "2"}), 2, {"--speed", "--simple opens no window"});
  expectRefused(with({"--screenshot", "a.png", "--speed", "2"}), 2, {"--speed", "--video"});
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(RunCommand, RefusesUnknownNames) {
  expectRefused({"--simple", "--frobnicate"}, 2, {"--frobnicate"});
  expectRefused({"frobnicate"}, 2, {"frobnicate"});
  expectRefused({"--simple", "--robot", "arn"}, 2, {"arn", "arm"});
  expectRefused({"--simple", "--controller", "asn"}, 2, {"asn", "asm"});
  expectRefused({"--simple", "--physics", "newton"}, 2, {"newton", "original"});
  expectRefused({"--simple", "--stepper", "fast"}, 2, {"fast", "chain"});
  expectRefused({"--simple", "--task", "fly"}, 2, {"fly", "height"});
  expectRefused({"--simple", "--initial-state", "flat", "--robot", "rig", "--controller", "hold"}, 2, {"flat", "settled"});
  expectRefused({"--simple", "--set", "arm.muscle_cont=3"}, 2, {"arm.muscle_cont", "arm.muscle_count"});
  expectRefused({"--simple", "--set", "load_kg=3", "--robot", "rig", "--controller", "hold"}, 2, {"load_kg", "rig.load_kg"});
}

TEST_F(RunCommand, RefusesNumbersThatCannotBe) {
  for (const char* step : {"0", "-0.01", "nan", "inf", "abc", "1e-300", "1e9", ""})
    expectRefused({"--simple", "--step", step}, 2, {"step"});
  for (const char* duration : {"0", "-5", "nan", "text"}) expectRefused({"--simple", "--duration", duration}, 2, {"duration"});
  expectRefused({"--simple", "--substeps", "0"}, 2, {"substeps"});
  expectRefused({"--simple", "--substeps", "-2"}, 2, {"substeps"});
  expectRefused({"--simple", "--muscles", "0"}, 2, {"arm.muscle_count"});
  expectRefused({"--simple", "--muscles", "31"}, 2, {"arm.muscle_count", "30"});
  expectRefused({"--simple", "--seed", "-1"}, 2, {"seed"});
  expectRefused({"--simple", "--decision-interval", "0"}, 2, {"decision-interval"});
  expectRefused({"--simple", "--decision-interval", "nan"}, 2, {"decision-interval"});
  expectRefused({"--simple", "--record-interval", "-1"}, 2, {"record-interval"});
  expectRefused({"--simple", "--target", "1,2"}, 2, {"target"});
  expectRefused({"--simple", "--set", "muscle.bead_mass_g=-3"}, 2, {"muscle.bead_mass_g", "-3", "0.001", "g"});
  expectRefused({"--simple", "--set", "muscle.bead_mass_g=heavy"}, 2, {"muscle.bead_mass_g", "heavy"});
  expectRefused({"--simple", "--set", "muscle.bead_mass_g"}, 2, {"name=value"});
}

TEST_F(RunCommand, RefusesTheHeightTaskForARobotWithoutAHand) {
  expectRefused({"--simple", "--robot", "rig", "--task", "height", "--duration", "0.1", "--record", "x.csv"}, 2, {"hand"});
}

TEST_F(RunCommand, RefusesBrokenAndMissingConfigFiles) {
  expectRefused({"--simple", "--config", "missing.toml"}, 5, {"missing.toml"});
  std::ofstream(folder_ / "broken.toml") << "[muscle\nbead_mass_g = 3\n";
  expectRefused({"--simple", "--config", "broken.toml"}, 3, {"broken.toml:1"});
}

TEST_F(RunCommand, ReportsFoldersThatCannotBeWritten) {
  std::ofstream(folder_ / "file") << "not a folder";
  expectRefused({"--simple", "--robot", "rig", "--controller", "hold", "--out", "file/below"}, 5, {"file/below"});
  expectRefused({"--simple", "--robot", "rig", "--controller", "hold", "--out", "/proc/nowhere"}, 5, {"/proc/nowhere"});
  expectRefused({"--simple", "--robot", "rig", "--controller", "hold", "--record", "run.txt"}, 2, {"run.txt", ".csv"});
}

TEST_F(RunCommand, HelpAndVersion) {
  const ProgramResult help = run({"--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* word : {"--simple", "--step", "--verbose", "--set NAME=VALUE", "replay", "Exit status"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
  const ProgramResult version = run({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_NE(version.out.find("musclesim 0."), std::string::npos);
  EXPECT_EQ(run({"replay", "--help"}).status, 0);
  EXPECT_NE(run({"diagnose", "--help"}).out.find("--exclude VALUE,..."), std::string::npos) << "a list, no words behind spaces";
  EXPECT_NE(run({"experiment", "--help"}).out.find("--where COLUMN=VALUE,... Needs: --data"), std::string::npos);
}

}  // namespace
}  // namespace musclesim
