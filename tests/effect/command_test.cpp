/// Command stage: limit cases in closed form.
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

TEST(CommandQuantisation, RoundsToItsLevels) {
  const Recording commands = wavesFor("rig", 0.3);
  const ReplayResult run = replayWith(commands, {{"command_quantisation", "all", {{"bits", 4.0}}}});
  for (std::size_t row = 0; row < commands.time_s.size(); ++row)
    EXPECT_DOUBLE_EQ(valuesOf(run, "pressure_0")[row], std::round(commands.signals[0].values[row] * 15) / 15);
}

TEST(CommandQuantisation, MayHaveFullScaleOneLevelBeyondTheHighest) {
  const Recording commands = wavesFor("rig", 0.3);
  const ReplayResult run = replayWith(commands, {{"command_quantisation", "all", {{"bits", 4.0}, {"top_level", 0.0}}}});
  for (std::size_t row = 0; row < commands.time_s.size(); ++row)
    EXPECT_DOUBLE_EQ(valuesOf(run, "pressure_0")[row], std::round(commands.signals[0].values[row] * 16) / 16);
}

TEST(CommandQuantisation, TruncatesToTheLevelBelow) {
  const Recording commands = wavesFor("rig", 0.3);
  const ReplayResult run = replayWith(commands, {{"command_quantisation", "all", {{"bits", 4.0}, {"rounding_point", 1.0}}}});
  for (std::size_t row = 0; row < commands.time_s.size(); ++row)
    EXPECT_DOUBLE_EQ(valuesOf(run, "pressure_0")[row], std::floor(commands.signals[0].values[row] * 15) / 15);
}

TEST(CommandDeadBand, LeavesSmallCommandsAtZero) {
  const Recording commands = commandsFor("rig", 0.3, [](double t) { return Action{0.5 * t}; });
  const ReplayResult run = replayWith(commands, {{"command_dead_band", "all", {{"threshold", 0.1}}}});
  for (std::size_t row = 0; row < commands.time_s.size(); ++row) {
    const double u = commands.signals[0].values[row];
    EXPECT_EQ(valuesOf(run, "pressure_0")[row], u < 0.1 ? 0 : u);
  }
}

TEST(CommandDeadBand, WithHysteresisClosesBelowWhereItOpened) {
  const Recording commands = commandsFor("rig", 0.6, [](double t) { return Action{0.3 - std::abs(t - 0.3)}; });
  const ReplayResult run = replayWith(commands, {{"command_dead_band", "all", {{"threshold", 0.2}, {"hysteresis", 0.4}}}});
  for (std::size_t row = 0; row < commands.time_s.size(); ++row) {
    const double u = commands.signals[0].values[row];
    const bool rises = commands.time_s[row] < 0.3;
    EXPECT_EQ(valuesOf(run, "pressure_0")[row], u >= (rises ? 0.2 : 0.12) ? u : 0) << commands.time_s[row];
  }
}

TEST(ChannelSwap, ExchangesTwoMusclesAndTwiceNothing) {
  const Recording commands = wavesFor("elbow", 0.3);
  const ReplayResult run = replayWith(commands, {{"channel_swap", "muscle_1+muscle_0", {}}});
  EXPECT_EQ(valuesOf(run, "pressure_0"), commands.signals[1].values);
  EXPECT_EQ(valuesOf(run, "pressure_1"), commands.signals[0].values);
  EXPECT_EQ(valuesOf(run, "command_0"), commands.signals[0].values);
  expectSame(replayWith(commands, {{"channel_swap", "muscle_0+muscle_1", {}}, {"channel_swap", "muscle_0+muscle_1", {}}}).simulated,
             replayWith(commands, {}).simulated);
}

}  // namespace
}  // namespace musclesim
