// musclesim schedule, figure, and the commands and signals of run
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "musclesim/controller/test_signal.h"
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
class Commands : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("musclesim_commands_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  ProgramResult run(const std::vector<std::string>& arguments) { return runProgram(arguments, folder_); }
  ProgramResult simulate(const std::string& robot, std::vector<std::string> more) {
    more.insert(more.begin(), {"--simple", "--robot", robot});
    return run(more);
  }
  Recording recording(const std::string& name) { return readRecording((folder_ / name).string()); }
  nlohmann::json verdict(const ProgramResult& result) { return nlohmann::json::parse(result.out.substr(result.out.rfind("\n{") + 1)); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

  fs::path folder_;
};

TEST_F(Commands, ASchedulePlayedRecordedAndReadIsTheSameToTheBit) {
  for (const TestSignalInfo& signal : testSignals()) {
    const std::string& name = signal.name;
    ASSERT_EQ(run({"schedule", name, "--robot", "elbow", "-o", name + ".csv", "--duration", "3", "--seed", "5"}).status, 0) << name;
    ASSERT_EQ(simulate("elbow", {"--commands", name + ".csv", "--muscle", "line", "--record", "played.csv"}).status, 0) << name;
    ASSERT_EQ(
        simulate("elbow", {"--controller", name, "--seed", "5", "--duration", "3", "--muscle", "line", "--record", "direct.csv"}).status,
        0);
    const Recording written = recording(name + ".csv"), played = recording("played.csv"), direct = recording("direct.csv");
    ASSERT_EQ(written.time_s.size(), 301u);
    EXPECT_EQ(played.time_s, written.time_s) << "runs to the end of the commands";
    for (const char* command : {"command_0", "command_1"}) {
      EXPECT_EQ(played.find(command)->values, written.find(command)->values) << name;
      EXPECT_EQ(direct.find(command)->values, written.find(command)->values) << name;
    }
    EXPECT_EQ(played.find("angle_elbow_deg")->values, direct.find("angle_elbow_deg")->values) << name;
  }
}

TEST_F(Commands, SchedulesMayBeInTheUnitOfAMachine) {
  ASSERT_EQ(run({"schedule", "steps", "--robot", "rig", "-o", "kPa.csv", "--duration", "1", "--full-scale-kPa", "600"}).status, 0);
  EXPECT_TRUE(contains(contentOf(folder_ / "kPa.csv"), "time_s,command_0_kPa\n0,240\n"));
  EXPECT_NEAR(recording("kPa.csv").find("command_0")->values[60], 0.5, 1e-15);
  ASSERT_EQ(run({"schedule", "steps", "--robot", "rig", "-o", "V.csv", "--duration", "1", "--full-scale-V", "10"}).status, 0);
  EXPECT_TRUE(contains(contentOf(folder_ / "V.csv"), "time_s,command_0_V\n0,4\n"));
  EXPECT_EQ(simulate("rig", {"--commands", "V.csv"}).status, 0);
}

TEST_F(Commands, BareTablesAndRecordingsArePlayedAtTheRecordingInterval) {
  write("table.csv", "time_s,command_0\n0,0.3\n0.25,0.5\n1,0.4\n");
  ASSERT_EQ(simulate("rig", {"--commands", "table.csv", "--record-interval", "0.05", "--record", "held.csv"}).status, 0);
  const Recording held = recording("held.csv");
  ASSERT_EQ(held.time_s.size(), 21u);
  EXPECT_EQ(held.find("command_0")->values[4], 0.3);
  EXPECT_EQ(held.find("command_0")->values[5], 0.5);
  ASSERT_EQ(simulate("rig", {"--commands", "held.csv", "--interpolate", "linear", "--record", "line.csv"}).status, 0);
  EXPECT_NEAR(recording("line.csv").find("command_0")->values[22], 0.3 + 0.2 * 0.4, 1e-12);
  write("two.csv", "time_s,command_0,command_1\n0,0.3,0.3\n");
  EXPECT_TRUE(contains(simulate("rig", {"--commands", "two.csv"}).err, "more than the 1 muscles"));
  write("odd.csv", "time_s,comand_0\n0,0.3\n");
  const ProgramResult odd = simulate("rig", {"--commands", "odd.csv"});
  EXPECT_EQ(odd.status, 3);
  EXPECT_TRUE(contains(odd.err, "odd.csv:1:8")) << odd.err;
}

TEST_F(Commands, OptionsOfOtherControllersAreRefused) {
  write("table.csv", "time_s,command_0\n0,0.3\n1,0.4\n");
  const auto refusal = [&](std::vector<std::string> arguments) {
    const ProgramResult result = simulate("rig", std::move(arguments));
    EXPECT_EQ(result.status, 2) << result.err;
    return result.err;
  };
  EXPECT_TRUE(contains(refusal({"--controller", "hold", "--commands", "table.csv"}), "--commands is for --controller schedule"));
  EXPECT_TRUE(contains(refusal({"--controller", "schedule"}), "--commands FILE.csv"));
  EXPECT_TRUE(contains(refusal({"--controller", "sine", "--interpolate", "linear"}), "--interpolate"));
  EXPECT_TRUE(contains(refusal({"--controller", "hold", "--channels", "0"}), "--channels"));
  EXPECT_TRUE(contains(refusal({"--controller", "sine", "--targets", "table.csv"}), "--targets"));
  EXPECT_TRUE(contains(refusal({"--controller", "sine", "--channels", "0:1"}), "channel = 0:1"));
  EXPECT_TRUE(contains(run({"schedule", "sinus", "-o", "a.csv"}).err, "sine"));
}

TEST_F(Commands, RobotsWithoutAHandRunByThemselves) {
  const ProgramResult rig = simulate("rig", {"--duration", "0.1"});
  ASSERT_EQ(rig.status, 0) << rig.err;
  EXPECT_TRUE(contains(rig.out, "rig-triangle-1")) << rig.out;
  EXPECT_FALSE(contains(rig.out, "height")) << rig.out;
  const ProgramResult held = simulate("elbow", {"--controller", "hold", "--duration", "0.1"});
  EXPECT_TRUE(contains(held.out, "elbow-hold-1")) << held.out;
  EXPECT_TRUE(contains(simulate("elbow", {"--task", "height", "--duration", "0.1"}).out, "height-1"));
}

TEST_F(Commands, AFinishedRunIsReplacedOnRequestOnly) {
  const std::vector<std::string> arguments = {"--controller", "hold", "--duration", "0.1", "--out", "run"};
  ASSERT_EQ(simulate("rig", arguments).status, 0);
  const std::string before = contentOf(folder_ / "run" / "run.csv");
  std::vector<std::string> other = arguments;
  other.insert(other.end(), {"--set", "hold.pressure=0.6"});
  const ProgramResult refused = simulate("rig", other);
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(contains(refused.err, "--overwrite")) << refused.err;
  EXPECT_EQ(contentOf(folder_ / "run" / "run.csv"), before);
  other.push_back("--overwrite");
  EXPECT_EQ(simulate("rig", other).status, 0);
  EXPECT_NE(contentOf(folder_ / "run" / "run.csv"), before);
  auto sidecar = nlohmann::json::parse(contentOf(folder_ / "run" / "run.json"));
  sidecar["complete"] = false;
  write("run/run.json", sidecar.dump());
  EXPECT_EQ(simulate("rig", arguments).status, 0) << "a run that stopped early";
}

TEST_F(Commands, SaysThatItMakesAFolder) {
  const std::vector<std::string> arguments = {"--controller", "hold", "--duration", "0.1", "--record", "new/deep/run.csv"};
  EXPECT_TRUE(contains(simulate("rig", arguments).err, "made the folder new/deep"));
  EXPECT_FALSE(contains(simulate("rig", arguments).err, "made the folder"));
}

TEST_F(Commands, AConfigurationOfAnotherControllerIsAccepted) {
  const ProgramResult printed = simulate("elbow", {"--controller", "asm", "--set", "elbow.forearm_kg=0.7", "--print-config"});
  write("model.toml", printed.out);
  const ProgramResult held =
      simulate("elbow", {"--controller", "hold", "--config", "model.toml", "--duration", "0.1", "--record", "a.csv"});
  ASSERT_EQ(held.status, 0) << held.err;
  EXPECT_TRUE(contains(held.err, "asm.noise_std")) << "not in silence: " << held.err;
  EXPECT_EQ(std::get<double>(recording("a.csv").info.robot_parameters.at("forearm_kg")), 0.7);
  EXPECT_EQ(simulate("rig", {"--controller", "hold", "--config", "model.toml", "--duration", "0.1"}).status, 3)
      << "another robot's numbers";
  EXPECT_EQ(simulate("elbow", {"--controller", "hold", "--set", "asm.noise_std=0.1", "--duration", "0.1"}).status, 2);
}

TEST_F(Commands, RecordsChosenSignalsAndTheirVelocities) {
  ASSERT_EQ(simulate("elbow", {"--controller", "sine", "--muscle", "line", "--duration", "2", "--record", "a.csv", "--record-signals",
                               "angle_elbow_deg,angle_elbow_deg_per_s,angle_elbow_deg_per_s2"})
                .status,
            0);
  const Recording chosen = recording("a.csv");
  ASSERT_EQ(chosen.signals.size(), 5u) << "two commands and these";
  const auto& v = chosen.find("angle_elbow_deg_per_s")->values;
  const auto& a = chosen.find("angle_elbow_deg_per_s2")->values;
  EXPECT_TRUE(std::isnan(v[1]) && !std::isnan(v[2]) && std::isnan(a[2]) && !std::isnan(a[3]));
  const ProgramResult wrong = simulate("elbow", {"--record-signals", "angle_elbw_deg", "--duration", "0.1"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(contains(wrong.err, "did you mean \"angle_elbow_deg\"")) << wrong.err;
  EXPECT_EQ(run({"replay", "a.csv", "--quiet"}).status, 0) << "velocities are no signals of the model";
}

TEST_F(Commands, VelocitiesAndAccelerationsAreThoseOfTheMotion) {
  ASSERT_EQ(simulate("rig", {"--controller", "sine", "--muscle", "line", "--duration", "3", "--record", "a.csv", "--record-signals",
                             "length_0_mm,length_0_mm_per_s,length_0_mm_per_s2"})
                .status,
            0);
  const Recording smooth = recording("a.csv");
  const auto& y = smooth.find("length_0_mm")->values;
  const auto& v = smooth.find("length_0_mm_per_s")->values;
  const auto& a = smooth.find("length_0_mm_per_s2")->values;
  // Against central differences, which know the reading after the row and are not what the program computes.
  double v_squares = 0, v_errors = 0, a_squares = 0, a_errors = 0;
  for (std::size_t k = 20; k + 1 < y.size(); ++k) {
    const double speed = (y[k + 1] - y[k - 1]) / 0.02, acceleration = (y[k + 1] - 2 * y[k] + y[k - 1]) / 1e-4;
    v_squares += speed * speed, v_errors += std::pow(v[k] - speed, 2);
    a_squares += acceleration * acceleration, a_errors += std::pow(a[k] - acceleration, 2);
  }
  EXPECT_GT(v_squares / static_cast<double>(y.size()), 100) << "the load moves, RMS 10 mm/s";
  EXPECT_LT(std::sqrt(v_errors / v_squares), 0.01);
  EXPECT_LT(std::sqrt(a_errors / a_squares), 0.1);
}

TEST_F(Commands, SummarisesSignals) {
  write("up.csv", "time_s,command_0\n0,0.3\n0.5,0.5\n6,0.5\n");
  const auto begin = std::chrono::steady_clock::now();
  const ProgramResult result =
      simulate("rig", {"--commands", "up.csv", "--record", "a.csv", "--summarise", "command_0,length_0_mm", "--json"});
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = verdict(result);
  const Recording run = recording("a.csv");
  const auto& length = run.find("length_0_mm")->values;
  const auto& summary = json["signals"]["length_0_mm"];
  EXPECT_EQ(summary["last"], length.back());
  EXPECT_EQ(summary["peak"], *std::ranges::max_element(length));
  EXPECT_EQ(summary["trough"], *std::ranges::min_element(length));
  EXPECT_NEAR(json["signals"]["command_0"]["mean"].get<double>(), (0.3 * 50 + 0.5 * 551) / 601, 1e-12);
  const double change = length.back() - length.front();
  ASSERT_LT(change, -10) << "the muscle becomes shorter";
  EXPECT_NEAR(summary["overshoot"].get<double>(), (length.back() - summary["trough"].get<double>()) / -change, 1e-12);
  const double settled_s = summary["settling_time_s"];
  EXPECT_GT(settled_s, 0.5);
  for (std::size_t row = 0; row < length.size(); ++row)
    EXPECT_LE(run.time_s[row] >= settled_s - 1e-9 ? std::abs(length[row] - length.back()) : 0, 0.02 * std::abs(change)) << row;
  EXPECT_EQ(json["signals"]["command_0"]["settling_time_s"], 0.5);
  EXPECT_GT(json["real_time_factor"].get<double>(), 6 / elapsed_s) << "the run is a part of the program's time";
  EXPECT_NEAR(json["real_time_factor"].get<double>() * json["wall_s"].get<double>(), 6, 1e-6) << "simulated over wall";
  const ProgramResult heavier = simulate("rig", {"--commands", "up.csv", "--record", "b.csv", "--set", "rig.load_kg=2.2", "--summarise",
                                                 "length_0_mm", "--against", "a.csv", "--json"});
  double squares = 0;
  const Recording other = recording("b.csv");
  for (std::size_t row = 0; row < length.size(); ++row) squares += std::pow(other.find("length_0_mm")->values[row] - length[row], 2);
  EXPECT_NEAR(verdict(heavier)["signals"]["length_0_mm"]["rmse"].get<double>(), std::sqrt(squares / static_cast<double>(length.size())),
              1e-9);
  EXPECT_TRUE(contains(simulate("rig", {"--summarise", "length_1_mm", "--duration", "0.1"}).err, "length_0_mm"));
}

TEST_F(Commands, PrintsTheSummaryForPeople) {
  write("up.csv", "time_s,command_0\n0,0.3\n0.5,0.5\n6,0.5\n");
  const ProgramResult result = simulate("rig", {"--commands", "up.csv", "--record", "a.csv", "--summarise", "command_0,length_0_mm"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "signal             last        mean        peak      trough  settling_time_s   overshoot\n"))
      << result.out;
  EXPECT_TRUE(contains(result.out, "command_0           0.5")) << result.out;
  EXPECT_FALSE(contains(result.out, "rmse"));
}

TEST_F(Commands, AChangeWithinTheNoiseHasNoOvershoot) {
  const std::vector<std::string> held = {"--controller",
                                         "hold",
                                         "--duration",
                                         "2",
                                         "--record",
                                         "a.csv",
                                         "--summarise",
                                         "length_0_mm,force_0_N",
                                         "--json",
                                         "--record-signals",
                                         "pressure_0",
                                         "--set",
                                         "sensor.length_noise_mm=0.05"};
  const ProgramResult result = simulate("rig", held);
  ASSERT_EQ(result.status, 0) << result.err;
  const auto summary = verdict(result)["signals"]["length_0_mm"];
  EXPECT_GT(summary["peak"].get<double>() - summary["trough"].get<double>(), 0.1) << "noise";
  EXPECT_TRUE(summary["overshoot"].is_null()) << summary;
  EXPECT_TRUE(summary["settling_time_s"].is_null()) << summary;
  EXPECT_TRUE(contains(result.err, "also recorded, because the verdict needs them: length_0_mm, force_0_N")) << result.err;
}

TEST_F(Commands, WhatStillMovesHasNotSettled) {
  const ProgramResult result = simulate("elbow", {"--controller", "sine", "--muscle", "line", "--duration", "4.25", "--record", "a.csv",
                                                  "--summarise", "command_0", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto summary = verdict(result)["signals"]["command_0"];
  EXPECT_NE(summary["peak"], summary["last"]);
  EXPECT_TRUE(summary["settling_time_s"].is_null() && summary["overshoot"].is_null()) << summary;
}

TEST_F(Commands, WhatTheVerdictNeedsIsRecordedWithChosenSignals) {
  const ProgramResult result = simulate("elbow", {"--controller", "position", "--duration", "0.2", "--record", "a.csv", "--record-signals",
                                                  "pressure_0", "--summarise", "angle_elbow_deg_per_s", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(verdict(result)["tracking"].contains("elbow"));
  EXPECT_TRUE(verdict(result)["signals"].contains("angle_elbow_deg_per_s"));
  const Recording run = recording("a.csv");
  for (const char* name : {"target_elbow_deg", "angle_elbow_deg", "angle_elbow_deg_per_s", "pressure_0"})
    EXPECT_TRUE(run.find(name)) << name;
  EXPECT_FALSE(run.find("length_0_mm"));
}

TEST_F(Commands, DrawsChosenSignals) {
  ASSERT_EQ(simulate("elbow", {"--controller", "triangle", "--duration", "0.5", "--record", "a.csv", "--figure-signals", "angle_elbow_deg"})
                .status,
            0);
  const std::string figure = contentOf(folder_ / "a.svg");
  EXPECT_TRUE(contains(figure, "angle (deg)"));
  EXPECT_FALSE(contains(figure, "pressure_0"));
  ASSERT_EQ(run({"figure", "a.csv", "--signals", "hand_x_mm,command_*", "-o", "b.svg", "--title", "a title"}).status, 0);
  const std::string other = contentOf(folder_ / "b.svg");
  for (const char* word : {"a title", "hand (mm)", "command (fraction)", "command_1"}) EXPECT_TRUE(contains(other, word)) << word;
  const ProgramResult wrong = run({"figure", "a.csv", "--signals", "angle_elbow"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(contains(wrong.err, "angle_elbow_deg")) << wrong.err;
}

TEST_F(Commands, ThePositionLoopHoldsTheElbowAndTheArm) {
  const ProgramResult elbow = simulate("elbow", {"--controller", "position", "--set", "position.amplitude_elbow_deg=20", "--duration", "6",
                                                 "--record", "elbow.csv", "--json"});
  ASSERT_EQ(elbow.status, 0) << elbow.err;
  EXPECT_LT(verdict(elbow)["tracking"]["elbow"]["largest_deg"].get<double>(), 0.5);
  EXPECT_TRUE(contains(elbow.err, "elbow=0:1")) << elbow.err;
  EXPECT_NEAR(recording("elbow.csv").find("target_elbow_deg")->values[150], -20, 1e-9) << "three quarters of a cycle of 2 s";
  for (const double target_mm : {-180.0, -120.0, -60.0}) {
    const ProgramResult arm =
        run({"--simple", "--controller", "position", "--set", "position.quantity=height", "--set", "position.level=0.2", "--channels",
             "5+7:4", "--target", "0," + std::to_string(target_mm) + ",0", "--duration", "10", "--record", "arm.csv", "--json"});
    ASSERT_EQ(arm.status, 0) << arm.err;
    const Recording run = recording("arm.csv");
    for (std::size_t row = 500; row < run.time_s.size(); ++row)
      ASSERT_NEAR(run.find("hand_y_mm")->values[row], target_mm, 10) << run.time_s[row] << " s";
    EXPECT_EQ(run.find("target_y_mm")->values.back(), target_mm);
  }
}

}  // namespace
}  // namespace musclesim
