/// Combination of effects: their order, several at once, several on different components, sidecars, classes written by users.
#include "musclesim/effect/effect_chain.h"

#include "effect_runs.h"
#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

ActiveEffect lag(const std::string& component, double fill_s, double vent_s) {
  return {"valve_lag", component, {{"fill_time_constant_s", fill_s}, {"vent_time_constant_s", vent_s}}};
}

TEST(EffectChain, OrderOfTheListDoesNotMatter) {
  const Recording commands = wavesFor("elbow", 0.3);
  const ActiveEffect delay{"transport_delay", "all", {{"delay_s", 0.03}}};
  const ActiveEffect bias{"sensor_bias", "signal_angle_elbow", {{"offset", 2.0}}};
  const ReplayResult one = replayWith(commands, {delay, lag("muscle_0", 0.1, 0.1), bias});
  const ReplayResult other = replayWith(commands, {bias, lag("muscle_0", 0.1, 0.1), delay});
  expectSame(one.simulated, other.simulated);
}

TEST(EffectChain, TheSameIdOnTwoComponents) {
  const Recording commands = wavesFor("elbow", 0.3);
  const ReplayResult both = replayWith(commands, {lag("muscle_0", 0.1, 0.1), lag("muscle_1", 0.02, 0.02)});
  const ReplayResult first = replayWith(commands, {lag("muscle_0", 0.1, 0.1)});
  const ReplayResult second = replayWith(commands, {lag("muscle_1", 0.02, 0.02)});
  EXPECT_EQ(valuesOf(both, "pressure_0"), valuesOf(first, "pressure_0"));
  EXPECT_EQ(valuesOf(both, "pressure_1"), valuesOf(second, "pressure_1"));
  EXPECT_NE(valuesOf(both, "pressure_0"), valuesOf(second, "pressure_0"));
}

TEST(EffectChain, AllIsEveryComponent) {
  const Recording commands = wavesFor("elbow", 0.3);
  expectSame(replayWith(commands, {lag("all", 0.1, 0.05)}).simulated,
             replayWith(commands, {lag("muscle_1", 0.1, 0.05), lag("muscle_0", 0.1, 0.05)}).simulated);
}

TEST(EffectChain, ARunBeginsSettledWithItsEffects) {
  const Recording commands = commandsFor("rig", 0.5, [](double) { return Action{0.5}; });
  const ReplayResult run = replayWith(commands, {lag("all", 0.3, 0.3), {"transport_delay", "all", {{"delay_s", 0.2}}}});
  for (const double pressure : valuesOf(run, "pressure_0")) EXPECT_DOUBLE_EQ(pressure, 0.5);
}

TEST(EffectChain, StateBelongsToTheSimulation) {
  const Recording commands = wavesFor("rig", 0.3);
  const std::vector<ActiveEffect> effects = {lag("all", 0.1, 0.2), {"transport_delay", "all", {{"delay_s", 0.03}}}};
  expectSame(replayWith(commands, effects).simulated, replayWith(commands, effects).simulated);
}

TEST(EffectChain, ActiveEffectsOfARecordingArePartOfTheModel) {
  Recording commands = wavesFor("rig", 0.3);
  const std::vector<ActiveEffect> effects = {lag("all", 0.1, 0.2)};
  const ReplayResult given = replayWith(commands, effects);
  commands.info.active_effects = effects;
  const ReplayResult recorded = replayWith(commands, {});
  expectSame(given.simulated, recorded.simulated);
  EXPECT_EQ(given.simulated.info.active_effects, effects);
  EXPECT_EQ(recorded.simulated.info.active_effects, effects);
  const ReplayResult again = replayWith(given.simulated, {});
  expectSame(again.simulated, given.simulated);
}

TEST(EffectChain, AnUnknownComponentIsRefusedWithTheKnownOnes) {
  const std::string message = messageOf<BadParameter>([] {
    replayWith(wavesFor("elbow", 0.1), {{"joint_viscous_friction", "joint_wrist", {}}});
  });
  EXPECT_TRUE(contains(message, "joint_wrist"));
  EXPECT_TRUE(contains(message, "joint_elbow"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([] {
                         replayWith(wavesFor("rig", 0.1), {{"joint_viscous_friction", "all", {}}});
                       }),
                       "rig has no component that the effect can act on"));
}

TEST(EffectChain, EffectsNeedARobot) {
  SimulationOptions options;
  options.effects = {lag("all", 0.1, 0.1)};
  Simulation simulation(options);
  EXPECT_THROW(simulation.step(), BadParameter);
}

TEST(EffectValues, HaveOneValueForEachParameter) {
  const std::vector<EffectParameter> parameters = effectInfo("valve_lag").parameters;
  EXPECT_EQ(EffectValues(parameters, std::vector(parameters.size(), 0.1))["vent_time_constant_s"], 0.1);
  EXPECT_THROW(EffectValues(parameters, {0.1, 0.1}), std::logic_error);
}

TEST(EffectChain, AClassOfAnotherStageIsRefused) {
  registerEffect({.id = "misplaced",
                  .stage = Stage::force,
                  .acts_on = {ComponentKind::muscle},
                  .summary = "",
                  .equation = "",
                  .signature = "",
                  .source = "",
                  .parameters = {{"strength", "", 0, 0, 1, 0, 1, "strength"}},
                  .make = [](const EffectValues&) {
                    return effectInfo("valve_lag").make(EffectValues(effectInfo("valve_lag").parameters, {0.1, 0.1, 0}));
                  }});
  const std::string message = messageOf<BadParameter>([] {
    replayWith(wavesFor("rig", 0.1), {{"misplaced", "all", {{"strength", 1.0}}}});
  });
  EXPECT_TRUE(contains(message, "misplaced"));
  EXPECT_TRUE(contains(message, "force stage"));
}

}  // namespace
}  // namespace musclesim
