// Recordings whose columns can only be meant otherwise than they say.
#include "diagnosis/model/convention_check.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "musclesim/base/error.h"
#include "musclesim/base/random.h"

namespace musclesim {
namespace {

constexpr double full_scale_kPa = 600;

/// An elbow under steps and a wave in opposite directions, with a late valve and a sensor that reads 2 degrees too much.
Recording elbow(double wave_Hz, std::vector<ActiveEffect> effects = {}) {
  Recording plan;
  plan.file = "plan.csv";
  plan.info.robot = "elbow";
  plan.info.robot_parameters = {{"muscle.model", "line"}};
  plan.signals = {{"command_0", {}}, {"command_1", {}}};
  for (int row = 0; row < 300; ++row) {
    const double t = 0.01 * row, wave = 0.15 * std::sin(2 * std::numbers::pi * wave_Hz * t), step = std::fmod(t, 0.8) < 0.5 ? 0.1 : -0.1;
    plan.time_s.push_back(t);
    plan.signals[0].values.push_back(0.4 + wave + step);
    plan.signals[1].values.push_back(0.4 - wave - step);
  }
  ReplayOptions options;
  options.effects = std::move(effects);
  options.effects.push_back({"valve_lag", "all", {{"fill_time_constant_s", 0.05}, {"vent_time_constant_s", 0.08}}});
  options.effects.push_back({"sensor_bias", "signal_angle_elbow", {{"offset", 2.0}}});
  Recording recording = replayRecording(plan, options).simulated;
  recording.file = "elbow.csv";
  recording.info.active_effects.clear();
  recording.info.pressure_full_scale_kPa = full_scale_kPa;
  const std::vector<std::string> kept = {"command_0",       "command_1",   "pressure_0", "pressure_1",
                                         "angle_elbow_deg", "length_0_mm", "length_1_mm"};
  std::erase_if(recording.signals, [&](const Signal& s) { return std::ranges::find(kept, s.name) == kept.end(); });
  for (const Signal& signal : recording.signals)
    recording.info.noise_std[signal.name] = signal.name.starts_with("pressure_") ? 0.003 : 0.05;
  return recording;
}

std::vector<double>& valuesOf(Recording& recording, const std::string& name) {
  return std::ranges::find(recording.signals, name, &Signal::name)->values;
}

void leaveOut(Recording& recording, const std::string& first_letters) {
  std::erase_if(recording.signals, [&](const Signal& signal) { return signal.name.starts_with(first_letters); });
}

std::vector<std::string> notesOn(const Recording& recording) {
  DiagnosisOptions options;
  const Plant plant({recording}, options);
  return checkConventions(plant, {plant.predict(0, Model{})});
}

/// What the refusal says; empty if there is none.
std::string refusalOf(const Recording& recording) {
  try {
    notesOn(recording);
  } catch (const BadFile& error) {
    return error.what();
  }
  return "";
}

std::string refusalAfter(const std::function<void(Recording&)>& change) {
  Recording recording = elbow(1.7);
  change(recording);
  return refusalOf(recording);
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Conventions, OfARightRecordingAreAccepted) {
  EXPECT_EQ(refusalOf(elbow(1.7)), "");
  EXPECT_TRUE(notesOn(elbow(1.7)).empty());
}

TEST(Conventions, AReversedAngleIsRefused) {
  const std::string refusal = refusalAfter([](Recording& r) {
    for (double& v : valuesOf(r, "angle_elbow_deg")) v = -v;
  });
  EXPECT_TRUE(says(refusal, "elbow.csv: angle_elbow_deg moves opposite to the model")) << refusal;
  EXPECT_TRUE(says(refusal, "factor = -1") && says(refusal, "--trust-columns")) << refusal;
}

/// Without pressures nothing tells a reversed angle from exchanged commands, which are a cause.
TEST(Conventions, AReversedAngleAloneIsNoted) {
  Recording recording = elbow(1.7);
  for (double& v : valuesOf(recording, "angle_elbow_deg")) v = -v;
  leaveOut(recording, "pressure_");
  leaveOut(recording, "length_");
  const std::vector<std::string> notes = notesOn(recording);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(says(notes.front(), "angle_elbow_deg moves opposite to the model: either the commands"));
}

TEST(Conventions, ExchangedColumnsAreRefusedAndExchangedCommandsAreNot) {
  const auto exchange = [](const std::string& kind, const std::string& unit) {
    return [=](Recording& r) { std::swap(valuesOf(r, kind + "0" + unit), valuesOf(r, kind + "1" + unit)); };
  };
  const std::string pressures = refusalAfter(exchange("pressure_", ""));
  EXPECT_TRUE(says(pressures, "pressure_0 follows the model's pressure_1")) << pressures;
  const std::string lengths = refusalAfter(exchange("length_", "_mm"));
  EXPECT_TRUE(says(lengths, "length_0_mm follows the model's length_1_mm")) << lengths;
  EXPECT_EQ(refusalOf(elbow(1.7, {{"channel_swap", "muscle_0+muscle_1", {}}})), "");
}

/// Levels that change at random, so that no part of the motion resembles another.
Recording armUnderRandomLevels() {
  Recording plan;
  plan.file = "plan.csv";
  plan.info.robot = "pulley_arm";
  for (std::size_t m = 0; m < 6; ++m) plan.signals.push_back({fmt::format("command_{}", m), {}});
  RandomStream random(1, "levels");
  std::vector<double> level(3);  // of the muscles of the shoulder, of the elbow, of both
  for (int row = 0; row < 600; ++row) {
    if (row % 40 == 0)
      for (double& one : level) one = 0.1 * random.normal();
    plan.time_s.push_back(0.01 * row);
    for (std::size_t m = 0; m < 6; ++m) plan.signals[m].values.push_back(std::clamp(0.3 + (m % 2 ? -1 : 1) * level[m / 2], 0.0, 1.0));
  }
  ReplayOptions options;
  options.effects = {{"valve_lag", "all", {{"fill_time_constant_s", 0.05}, {"vent_time_constant_s", 0.08}}}};
  Recording recording = replayRecording(plan, options).simulated;
  recording.file = "arm.csv";
  recording.info.active_effects.clear();
  return recording;
}

TEST(Conventions, AnotherClockIsRefused) {
  Recording recording = armUnderRandomLevels();
  std::vector<double>& angle = valuesOf(recording, "angle_elbow_deg");
  EXPECT_EQ(refusalOf(recording), "");
  std::rotate(angle.begin(), angle.begin() + 150, angle.end());
  std::fill(angle.end() - 150, angle.end(), std::nan(""));
  const std::string refusal = refusalOf(recording);
  EXPECT_TRUE(says(refusal, "angle_elbow_deg moves as in the model, but 1.4 s earlier: do its clock")) << refusal;
}

/// No machine moves half a second before its command; half a second late it may be.
TEST(Conventions, AClockThatIsALittleEarlyIsRefused) {
  const auto movedBy = [](std::ptrdiff_t rows) {
    Recording recording = armUnderRandomLevels();
    for (const char* name : {"angle_elbow_deg", "angle_shoulder_deg"}) {
      std::vector<double>& angle = valuesOf(recording, name);
      if (rows > 0) {
        std::rotate(angle.begin(), angle.begin() + rows, angle.end());
        std::fill(angle.end() - rows, angle.end(), std::nan(""));
      } else {
        std::rotate(angle.rbegin(), angle.rbegin() - rows, angle.rend());
        std::fill(angle.begin(), angle.begin() - rows, std::nan(""));
      }
    }
    return refusalOf(recording);
  };
  EXPECT_TRUE(says(movedBy(55), "s earlier: do its clock")) << movedBy(55);
  EXPECT_EQ(movedBy(10), "") << "a twentieth of a second: the model may be as slow";
  EXPECT_EQ(movedBy(-50), "");
}

/// What the refusal of three recordings says, of which the second one is changed, and then all as `measure` does.
std::string refusalAmongOthers(const std::function<void(Recording&)>& change, const std::function<void(Recording&)>& measure = {}) {
  std::vector<Recording> recordings = {elbow(1.7), elbow(1.1), elbow(1.4)};
  for (std::size_t i = 0; i < recordings.size(); ++i) recordings[i].file = fmt::format("r{}.csv", i + 1);
  change(recordings[1]);
  if (measure)
    for (Recording& recording : recordings) measure(recording);
  DiagnosisOptions options;
  const Plant plant(recordings, options);
  try {
    checkConventions(plant, {plant.predict(0, Model{}), plant.predict(1, Model{}), plant.predict(2, Model{})});
  } catch (const BadFile& error) {
    return error.what();
  }
  return "";
}

TEST(Conventions, OneRecordingThatIsUnlikeTheOthersIsRefused) {
  EXPECT_EQ(refusalAmongOthers([](Recording&) {}), "");
  const std::string reversed = refusalAmongOthers([](Recording& r) {
    for (double& v : valuesOf(r, "angle_elbow_deg")) v = -v;
  });
  EXPECT_TRUE(says(reversed, "r2.csv: angle_elbow_deg moves opposite to the model there, but not in the other recordings")) << reversed;
  const std::string in_rad = refusalAmongOthers([](Recording& r) {
    for (double& v : valuesOf(r, "angle_elbow_deg")) v *= std::numbers::pi / 180;
  });
  EXPECT_TRUE(says(in_rad, "r2.csv: angle_elbow_deg moves") && says(in_rad, "not in rad")) << in_rad;
  const std::string exchanged = refusalAmongOthers([](Recording& r) { std::swap(valuesOf(r, "pressure_0"), valuesOf(r, "pressure_1")); });
  EXPECT_TRUE(says(exchanged, "r2.csv: pressure_1 follows the model's pressure_0 there")) << exchanged;
}

/// Friction holds a joint under a weak signal: its angle follows the model, but moves by a fiftieth of it. So do the lengths; and the noise
/// stays.
TEST(Conventions, AMachineThatFrictionHoldsInOneRecordingIsNotInRad) {
  const auto hold = [](Recording& r, const std::string& name) {
    std::vector<double>& values = valuesOf(r, name);
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    for (double& v : values) v = mean + (v - mean) / 55;
  };
  EXPECT_EQ(refusalAmongOthers([&](Recording& r) {
              for (const char* name : {"angle_elbow_deg", "length_0_mm", "length_1_mm"}) hold(r, name);
            }),
            "");
  const auto angleAlone = [&](const std::function<void(Recording&)>& change) {
    RandomStream noise(3, "test");
    return refusalAmongOthers(change, [&](Recording& r) {
      leaveOut(r, "length_");
      for (double& v : valuesOf(r, "angle_elbow_deg")) v += 0.1 * noise.normal();
    });
  };
  EXPECT_EQ(angleAlone([&](Recording& r) { hold(r, "angle_elbow_deg"); }), "");
}

TEST(Conventions, AnAngleThatBeginsAgainAfterATurnIsRefused) {
  const std::string refusal = refusalAfter([](Recording& r) {
    for (double& v : valuesOf(r, "angle_elbow_deg")) v = v < 3 ? v + 360 : v;
  });
  EXPECT_TRUE(says(refusal, "angle_elbow_deg jumps by about a turn") && says(refusal, "unwrap = 360")) << refusal;
}

TEST(Conventions, CommandsThatOpenNoValveWhileTheMachineMovesAreRefused) {
  const std::string refusal = refusalAfter([](Recording& r) {
    for (const char* name : {"command_0", "command_1", "pressure_0", "pressure_1"})
      for (double& v : valuesOf(r, name)) v /= 100;
  });
  EXPECT_TRUE(says(refusal, "commands stay below 0.65 % of full scale") && says(refusal, "bar or MPa, not kPa")) << refusal;
}

/// Pressures of antagonists that are exchanged may differ by about one atmosphere in the mean.
TEST(Conventions, AnotherMusclesPressureIsNotTakenForAnAbsoluteOne) {
  const std::string refusal = refusalAfter([](Recording& r) {
    std::vector<double>&one = valuesOf(r, "pressure_0"), &other = valuesOf(r, "pressure_1");
    std::swap(one, other);
    for (double& v : one) v += 101.3 / full_scale_kPa;
  });
  EXPECT_FALSE(says(refusal, "atmosphere")) << refusal;
}

TEST(Conventions, ExchangedJointsAreRefused) {
  Recording recording = armUnderRandomLevels();
  EXPECT_EQ(refusalOf(recording), "");
  std::swap(valuesOf(recording, "angle_shoulder_deg"), valuesOf(recording, "angle_elbow_deg"));
  const std::string refusal = refusalOf(recording);
  EXPECT_TRUE(says(refusal, "follows the model's angle_") && says(refusal, "are the two columns exchanged?")) << refusal;
}

TEST(Conventions, AllAnglesInRadiansAreRefused) {
  Recording recording = armUnderRandomLevels();
  for (const char* others : {"length_", "hand_"}) leaveOut(recording, others);
  for (const char* name : {"angle_shoulder_deg", "angle_elbow_deg"}) {
    for (double& v : valuesOf(recording, name)) v *= std::numbers::pi / 180;
  }
  const std::string refusal = refusalOf(recording);
  EXPECT_TRUE(says(refusal, "not in rad")) << refusal;
}

TEST(Conventions, OtherUnitsAndZerosAreRefused) {
  const auto changed = [](const std::string& name, double factor, double offset) {
    return refusalAfter([&](Recording& r) {
      for (double& v : valuesOf(r, name)) v = factor * v + offset;
    });
  };
  EXPECT_TRUE(says(changed("angle_elbow_deg", std::numbers::pi / 180, 0), "57.3"));
  EXPECT_TRUE(says(changed("angle_elbow_deg", 1, 270), "where the joint has its stops"));
  EXPECT_TRUE(says(changed("length_0_mm", 0.1, 0), "which is how long the muscle can be"));
  EXPECT_TRUE(says(changed("length_0_mm", 0.001, 0), "thousand"));
  EXPECT_TRUE(says(changed("pressure_0", 6, 1), "pressure_0_bar"));
  EXPECT_TRUE(says(refusalAfter([](Recording& r) {
                     for (double& time_s : r.time_s) time_s /= 1000;
                   }),
                   "is its clock in seconds?"));
  const std::string absolute = changed("pressure_1", 1, 101.3 / full_scale_kPa);
  EXPECT_TRUE(says(absolute, "about one atmosphere")) << absolute;
  EXPECT_EQ(changed("pressure_1", 1, 0.05), "") << "a sensor with a wrong zero";
  EXPECT_EQ(changed("angle_elbow_deg", 0.3, 10), "") << "friction, and a wrong zero";
}

/// Half a period late is no reversed sign, even where the lags that are tried meet that better than the true one.
TEST(Conventions, AWaveMayBeLate) {
  for (const auto& [wave_Hz, delay_s] : std::vector<std::pair<double, double>>{{1, 0.45}, {0.9, 0.3044}}) {
    Recording recording = elbow(wave_Hz);
    for (Signal& command : recording.signals) {
      const bool is_command = command.name.starts_with("command_");
      const double amplitude = command.name == "command_0" ? 0.15 : -0.15;
      for (std::size_t row = 0; is_command && row < command.values.size(); ++row)
        command.values[row] = 0.4 + amplitude * std::sin(2 * std::numbers::pi * wave_Hz * recording.time_s[row]);
    }
    ReplayOptions options;
    options.effects = {{"sensor_delay", "signal_angle_elbow", {{"delay_s", delay_s}}}};
    Recording late = replayRecording(recording, options).simulated;
    late.file = "late.csv";
    late.info.active_effects.clear();
    EXPECT_EQ(refusalOf(late), "") << delay_s;
  }
}

}  // namespace
}  // namespace musclesim
