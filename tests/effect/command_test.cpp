/// Command, pressure, body and sensor stage: limit cases in closed form.
#include "effect_runs.h"

namespace musclesim {
namespace {

Recording stepOfRig(double from, double to, double duration_s = 0.5) {
  return commandsFor("rig", duration_s, [=](double t) { return Action{t < 0.0999 ? from : to}; });
}

TEST(TransportDelay, ShiftsTheCommand) {
  const ReplayResult run = replayWith(stepOfRig(0.3, 0.5), {{"transport_delay", "all", {{"delay_s", 0.044}}}});
  for (std::size_t row = 0; row < run.simulated.time_s.size(); ++row)
    EXPECT_EQ(valuesOf(run, "pressure_0")[row], run.simulated.time_s[row] < 0.144 ? 0.3 : 0.5) << run.simulated.time_s[row];
}

TEST(ValveLag, AnswersAStepExponentially) {
  const std::vector<ActiveEffect> lag = {{"valve_lag", "all", {{"fill_time_constant_s", 0.08}, {"vent_time_constant_s", 0.15}}}};
  const ReplayResult filling = replayWith(stepOfRig(0.3, 0.5), lag), venting = replayWith(stepOfRig(0.5, 0.3), lag);
  for (std::size_t row = 0; row < filling.simulated.time_s.size(); ++row) {
    const double t = std::max(0.0, filling.simulated.time_s[row] - 0.1);
    EXPECT_NEAR(valuesOf(filling, "pressure_0")[row], 0.5 - 0.2 * std::exp(-t / 0.08), 1e-12);
    EXPECT_NEAR(valuesOf(venting, "pressure_0")[row], 0.3 + 0.2 * std::exp(-t / 0.15), 1e-12);
  }
}

TEST(SensorBias, AddsToTheReadingOnly) {
  const Recording commands = wavesFor("elbow", 0.3);
  const ReplayResult clean = replayWith(commands, {});
  const ReplayResult biased = replayWith(commands, {{"sensor_bias", "signal_angle_elbow", {{"offset", 2.5}}}});
  for (std::size_t row = 0; row < commands.time_s.size(); ++row)
    EXPECT_DOUBLE_EQ(valuesOf(biased, "angle_elbow_deg")[row], valuesOf(clean, "angle_elbow_deg")[row] + 2.5);
  for (const SignalError& error : compareSignals(biased.simulated, clean.simulated)) {
    if (error.name == "angle_elbow_deg") continue;
    EXPECT_EQ(error.largest, 0) << error.name;
  }
}

}  // namespace
}  // namespace musclesim
