/// Sensor stage: readings against closed forms, noise and lost samples against their statistics.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "effect_runs.h"
#include "musclesim/base/error.h"

namespace musclesim {
namespace {

/// Only one signal of a run may differ from the clean one.
void expectOnly(const std::string& signal, const ReplayResult& run, const ReplayResult& clean) {
  for (const SignalError& error : compareSignals(run.simulated, clean.simulated)) {
    if (error.name == signal) continue;
    EXPECT_EQ(error.largest, 0) << error.name;
  }
}

TEST(SensorBias, AddsToTheReadingOnly) {
  const Recording commands = wavesFor("elbow", 0.3);
  const ReplayResult clean = replayWith(commands, {});
  const ReplayResult run = replayWith(commands, {{"sensor_bias", "signal_angle_elbow", {{"offset", 2.5}}}});
  for (std::size_t row = 0; row < commands.time_s.size(); ++row)
    EXPECT_DOUBLE_EQ(valuesOf(run, "angle_elbow_deg")[row], valuesOf(clean, "angle_elbow_deg")[row] + 2.5);
  expectOnly("angle_elbow_deg", run, clean);
}

TEST(SensorGain, MultipliesTheReadingOnly) {
  const Recording commands = wavesFor("elbow", 0.3);
  const ReplayResult clean = replayWith(commands, {});
  const ReplayResult run = replayWith(commands, {{"sensor_gain", "signal_force_1", {{"gain", 1.1}}}});
  for (std::size_t row = 0; row < commands.time_s.size(); ++row)
    EXPECT_DOUBLE_EQ(valuesOf(run, "force_1_N")[row], 1.1 * valuesOf(clean, "force_1_N")[row]);
  expectOnly("force_1_N", run, clean);
}

TEST(SensorDelay, ShowsWhatWas) {
  const Recording commands = wavesFor("rig", 0.5);
  const ReplayResult clean = replayWith(commands, {});
  const ReplayResult run = replayWith(commands, {{"sensor_delay", "signal_length_0", {{"delay_s", 0.05}}}});
  for (std::size_t row = 5; row < commands.time_s.size(); ++row)
    EXPECT_NEAR(valuesOf(run, "length_0_mm")[row], valuesOf(clean, "length_0_mm")[row - 5], 1e-6) << row;
  expectOnly("length_0_mm", run, clean);
}

TEST(SensorDelay, MayBeAFilter) {
  const EffectInfo info = effectInfo("sensor_delay");
  const double delay_s = 0.04, h_s = 1e-3;
  for (const double share : {0.25, 1.0}) {
    auto effect = info.make(EffectValues(info.parameters, {delay_s, share}));
    auto& sensor = dynamic_cast<SensorEffect&>(*effect);
    sensor.reset();
    auto stepAt = [](double time_s) { return time_s > 0 ? 1.0 : 0.0; };
    for (double time_s = -0.1; time_s < 0.2; time_s += h_s) {
      sensor.track(stepAt(time_s), {time_s, h_s});
      const double since_s = time_s - (1 - share) * delay_s;
      const double expected = since_s > 0 ? 1 - std::exp(-since_s / (share * delay_s)) : 0;
      EXPECT_NEAR(sensor.reading(stepAt(time_s), {time_s, h_s}, 0), expected, 1.1 * h_s / (share * delay_s)) << share << " " << time_s;
    }
  }
}

/// A straight line read at (1 - r) t.
TEST(SlowClock, FallsBehindInProportionToTheTime) {
  const EffectInfo info = effectInfo("slow_clock");
  auto effect = info.make(EffectValues(info.parameters, {0.03}));
  auto& sensor = dynamic_cast<SensorEffect&>(*effect);
  sensor.reset();
  constexpr double h_s = 1e-3, slope = 7;
  for (int i = -500; i <= 20000; ++i) {
    const double time_s = h_s * i;
    sensor.track(slope * time_s, {time_s, h_s});
    const double read_s = time_s > 0 ? 0.97 * time_s : time_s;
    ASSERT_NEAR(sensor.reading(slope * time_s, {time_s, h_s}, 0), slope * read_s, 1e-9) << time_s;
  }
}

TEST(SlowClock, OfOneColumnLeavesTheOthersAlone) {
  const Recording commands = wavesFor("rig", 1);
  const ReplayResult clean = replayWith(commands, {});
  const ReplayResult slow = replayWith(commands, {{"slow_clock", "signal_length_0", {{"lag_per_s", 0.05}}}});
  expectOnly("length_0_mm", slow, clean);
  EXPECT_EQ(valuesOf(slow, "length_0_mm").front(), valuesOf(clean, "length_0_mm").front());
  EXPECT_THROW(replayWith(commands, {{"slow_clock", "all", {{"lag_per_s", -0.01}}}}), BadParameter) << "a fast clock would read ahead";
}

TEST(SensorBacklash, IsFlatAfterAReversalForItsWidth) {
  const EffectInfo info = effectInfo("sensor_backlash");
  SimulationOptions options;
  Simulation simulation(options);
  Robot& robot = simulation.build("elbow");
  auto effect = info.make(EffectValues(info.parameters, {2.0, 0.0}));
  auto& sensor = dynamic_cast<SensorEffect&>(*effect);
  const std::vector<std::string> names = robot.signalNames();
  const int angle = static_cast<int>(std::find(names.begin(), names.end(), "angle_elbow_deg") - names.begin());
  sensor.attach({simulation.world(), robot, ComponentKind::signal, -1, -1, "", angle, "signal_angle_elbow", false});
  sensor.reset();
  auto read = [&](double value) {
    sensor.track(value, {0, 1e-3});
    return sensor.reading(value, {0, 0}, 0);
  };
  EXPECT_EQ(read(5), 5);    // at the start
  EXPECT_EQ(read(5.5), 5);  // within the play
  EXPECT_EQ(read(10), 9);   // follows the upper bound
  EXPECT_EQ(read(8.5), 9);  // reversal: flat
  EXPECT_EQ(read(8), 9);    // flat over the whole width
  EXPECT_EQ(read(4), 5);    // follows the lower bound
}

TEST(SensorBacklash, NeedsAWidthInTheSignalsUnit) {
  const Recording commands = wavesFor("elbow", 0.05);
  EXPECT_THROW(replayWith(commands, {{"sensor_backlash", "signal_angle_elbow", {{"width_mm", 1.0}}}}), BadParameter);
  EXPECT_THROW(replayWith(commands, {{"sensor_backlash", "signal_pressure_0", {{"width_mm", 1.0}}}}), BadParameter);
  EXPECT_NO_THROW(replayWith(commands, {{"sensor_backlash", "all", {{"width_mm", 1.0}}}}));
}

TEST(SensorDropout, HoldsItsShareOfTheSamples) {
  const Recording commands = commandsFor("rig", 20, [](double t) { return Action{0.4 + 0.02 * t}; });
  ReplayOptions options;
  options.step_s = 0.01;
  options.substeps = 4;
  const ReplayResult clean = replayWith(commands, {}, options);
  const std::vector<ActiveEffect> lost = {{"sensor_dropout", "signal_pressure_0", {{"fraction", 0.2}, {"mean_gap_samples", 3.0}}}};
  const ReplayResult run = replayWith(commands, lost, options);
  const auto &held = valuesOf(run, "pressure_0"), &truth = valuesOf(clean, "pressure_0");
  long lost_count = 0;
  for (std::size_t row = 1; row < held.size(); ++row) {
    if (held[row] == truth[row]) continue;
    ++lost_count;
    EXPECT_EQ(held[row], held[row - 1]);
  }
  EXPECT_NEAR(static_cast<double>(lost_count) / static_cast<double>(held.size()), 0.2, 0.06);
  expectSame(replayWith(commands, lost, options).simulated, run.simulated);
  options.seed = 2;
  EXPECT_NE(valuesOf(replayWith(commands, lost, options), "pressure_0"), held);
}

TEST(SensorDropout, AReplayLosesTheSamplesThatTheRecordingLost) {
  const Recording commands = commandsFor("rig", 2, [](double t) { return Action{0.4 + 0.2 * t}; });
  const auto lossOf = [](double fraction) {
    return std::vector<ActiveEffect>{{"sensor_dropout", "signal_pressure_0", {{"fraction", fraction}}}};
  };
  ReplayOptions machine;
  machine.seed = 7;
  const Recording measured = [&] {
    Recording recording = replayWith(commands, lossOf(0.2), machine).simulated;
    recording.info.active_effects.clear();
    recording.info.seed.reset();
    return recording;
  }();
  const auto rmse = [](const ReplayResult& result, const std::string& signal) {
    return std::ranges::find(result.errors, signal, &SignalError::name)->rmse;
  };
  const ReplayResult without = replayWith(measured, {}), with = replayWith(measured, lossOf(0.3));
  EXPECT_GT(rmse(without, "pressure_0"), 1e-3);
  EXPECT_EQ(rmse(with, "pressure_0"), 0) << "whatever the fraction says";
  EXPECT_EQ(valuesOf(with, "length_0_mm"), valuesOf(without, "length_0_mm"));
  ASSERT_EQ(with.simulated.info.active_effects.size(), 1);
  EXPECT_EQ(with.simulated.info.active_effects.front().id, held_effect);
  EXPECT_THROW(replayWith(measured, lossOf(1.5)), BadParameter);
}

TEST(SensorNoise, HasItsDeviationAndIsPartOfTheRecording) {
  const Recording commands = commandsFor("rig", 10, [](double) { return Action{0.5}; });
  ReplayOptions options;
  options.substeps = 4;
  const ReplayResult clean = replayWith(commands, {}, options);
  options.parameters.set("sensor.length_noise_mm", 0.3, "test");
  const ReplayResult run = replayWith(commands, {}, options);
  double sum = 0, squares = 0;
  std::set<double> different;
  for (std::size_t row = 0; row < commands.time_s.size(); ++row) {
    const double noise = valuesOf(run, "length_0_mm")[row] - valuesOf(clean, "length_0_mm")[row];
    sum += noise;
    squares += noise * noise;
    different.insert(noise);
  }
  const double count = static_cast<double>(commands.time_s.size());
  EXPECT_NEAR(sum / count, 0, 4 * 0.3 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.3, 4 * 0.3 / std::sqrt(2 * count));
  EXPECT_EQ(different.size(), commands.time_s.size());
  EXPECT_EQ(run.simulated.info.noise_std, (std::map<std::string, double>{{"length_0_mm", 0.3}}));
  expectOnly("length_0_mm", run, clean);
}

TEST(Sensors, ReadingTwiceReadsTheSame) {
  SimulationOptions options;
  options.parameters.set("sensor.length_noise_mm", 0.3, "test");
  options.effects = {{"sensor_dropout", "all", {{"fraction", 0.5}}}, {"sensor_delay", "all", {{"delay_s", 0.02}}}};
  Simulation simulation(options);
  Robot& robot = simulation.build("elbow");
  simulation.start("settled", {0.3, 0.4});
  for (int i = 0; i < 20; ++i) {
    const State first = robot.getState(), second = robot.getState();
    EXPECT_EQ(first.length_mm, second.length_mm);
    EXPECT_EQ(first.pressure, second.pressure);
    simulation.step();
  }
}

TEST(Sensors, EverySignalOfEveryRobotHasThem) {
  for (const char* name : {"rig", "elbow", "arm"}) {
    SimulationOptions options;
    options.effects = {{"sensor_bias", "all", {{"offset", 1.0}}}};
    Simulation simulation(options);
    Robot& robot = simulation.build(name);
    simulation.start("built", Action(robot.actuators().size(), 0.5));
    const std::vector<double> readings = robot.signalValues(robot.getState()), truth = robot.signalValues(robot.truth());
    const std::vector<std::string> signals = robot.signalNames();
    for (std::size_t i = 0; i < signals.size(); ++i)
      EXPECT_DOUBLE_EQ(readings[i] - truth[i], signals[i].starts_with("command_") ? 0 : 1) << signals[i];
  }
}

}  // namespace
}  // namespace musclesim
