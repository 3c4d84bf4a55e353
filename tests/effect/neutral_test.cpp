/// For every effect of the catalogue, on all robots: a neutral effect changes no bit, and an effect that is not neutral changes the run.
#include <algorithm>
#include <map>

#include "effect_runs.h"
#include "musclesim/base/error.h"
#include "support/out_of_catalogue_laws.h"
#include "support/support.h"

namespace musclesim {
namespace {

double durationFor(const std::string& robot) {
  return robot == "arm" ? 0.03 : 0.25;
}

/// The run of a robot without effects, computed once.
const ReplayResult& cleanRun(const std::string& robot) {
  static std::map<std::string, ReplayResult> runs;
  const auto found = runs.find(robot);
  if (found != runs.end()) return found->second;
  return runs[robot] = replayRecording(wavesFor(robot, durationFor(robot)));
}

std::vector<std::string> componentsOf(const EffectInfo& info, const std::string& robot) {
  Simulation simulation;
  return componentsFor(info, simulation.build(robot));
}

/// Values with all strengths neutral; parameters that only say how an effect acts keep their defaults.
ActiveEffect neutralEffect(const EffectInfo& info, const std::string& component) {
  std::vector<double> values;
  for (const EffectParameter& p : info.parameters) values.push_back(p.shape ? p.usual_high : p.neutral);
  return activeEffect(info, component, values);
}

/// Values of usual strength, or strong enough to show in a short run.
ActiveEffect usualEffect(const EffectInfo& info, const std::string& component) {
  if (info.id == "foreign.hunt_crossley") return {info.id, component, {{"stiffness_Nm_per_deg15", 0.5}, {"plane_deg", 0.0}}};
  if (info.id == "foreign.tank") return {info.id, component, {{"loss_per_fill", 1.5}}};
  if (info.id == "joint_stop_offset") return {info.id, component, {{"offset_deg", 75.0}}};
  if (info.id == "contact")
    return {info.id,
            component,
            {{"stiffness_Nm_per_deg", 1.0}, {"stiffness_N_per_mm", 1.0}, {"plane_deg", 90.0}, {"plane_mm", 1000.0}, {"side", "below"}}};
  std::vector<double> values;
  for (const EffectParameter& p : info.parameters) values.push_back(p.shape ? p.neutral : p.usual_high);
  return activeEffect(info, component, values);
}

class EveryEffect : public ::testing::TestWithParam<std::string> {
 protected:
  EffectInfo info = effectInfo(GetParam());
};

TEST_P(EveryEffect, IsNoEffectBitForBitWhereNeutral) {
  if (info.parameters.empty()) GTEST_SKIP() << "has no parameters, so no neutral setting";
  for (const char* robot : {"rig", "elbow", "arm"}) {
    SCOPED_TRACE(robot);
    const std::vector<std::string> components = componentsOf(info, robot);
    if (components.empty()) continue;
    const ReplayResult& clean = cleanRun(robot);
    const ReplayResult neutral =
        replayWith(wavesFor(robot, durationFor(robot)), {neutralEffect(info, components.front()), neutralEffect(info, components.back())});
    expectSame(neutral.simulated, clean.simulated);
  }
}

TEST_P(EveryEffect, IsFeltWhereItIsNot) {
  for (const char* robot : {"rig", "elbow", "arm"}) {
    SCOPED_TRACE(robot);
    const std::vector<std::string> components = componentsOf(info, robot);
    const bool refused =
        info.id == "foreign.turned_end" && std::string(robot) == "rig";  // an offset of the end would act like one of the start
    if (components.empty() || refused) continue;
    const ReplayResult run = replayWith(wavesFor(robot, durationFor(robot)), {usualEffect(info, components.front())});
    ASSERT_FALSE(run.divergence) << *run.divergence;
    double largest = 0;
    for (const SignalError& error : compareSignals(run.simulated, cleanRun(robot).simulated)) largest = std::max(largest, error.largest);
    EXPECT_GT(largest, 0);
  }
}

TEST_P(EveryEffect, HasParametersThatAreRefusedOutOfRangeOrNotANumber) {
  const double nan = std::nan("");
  for (const EffectParameter& p : info.parameters) {
    for (const double value : {nan, std::nextafter(p.minimum, -INFINITY), std::nextafter(p.maximum, INFINITY)}) {
      if (value == p.minimum || value == p.maximum) continue;  // no bound
      const std::string message = messageOf<BadParameter>([&] { effectValues(info, {info.id, "all", {{p.name, value}}}); });
      EXPECT_TRUE(contains(message, info.id + "." + p.name));
    }
    EXPECT_LE(p.usual_low, p.usual_high) << p.name;
    EXPECT_GE(p.usual_low, p.minimum) << p.name;
    EXPECT_LE(p.usual_high, p.maximum) << p.name;
    EXPECT_FALSE(p.meaning.empty()) << p.name;
  }
  EXPECT_FALSE(info.equation.empty());
  EXPECT_FALSE(info.source.empty());
  EXPECT_FALSE(info.signature.empty());
}

TEST_P(EveryEffect, IsRefusedOnAComponentThatTheRobotDoesNotHave) {
  const std::string message = messageOf<BadParameter>([&] {
    SimulationOptions options;
    options.effects = {{info.id, "muscle_77", {}}};
    Simulation(options).build("elbow");
  });
  EXPECT_TRUE(contains(message, "component of " + info.id));
}

/// An effect that asks the muscles for their lengths would show: the body that stands still keeps those as built.
TEST(EffectsThatIgnoreMotion, MakeTheSamePressuresInABodyThatStandsStill) {
  ReplayOptions still;
  still.body_moves = false;
  int compared_count = 0;
  for (const EffectInfo& info : effectCatalogue()) {
    if (!info.ignores_motion) continue;
    EXPECT_TRUE(info.stage == Stage::command || info.stage == Stage::pressure);
    for (const char* robot : {"rig", "elbow", "arm"}) {
      SCOPED_TRACE(info.id + " on " + robot);
      const std::vector<std::string> components = componentsOf(info, robot);
      if (components.empty()) continue;
      const Recording commands = wavesFor(robot, durationFor(robot));
      const std::vector<ActiveEffect> effects = {usualEffect(info, components.front())};
      const ReplayResult moving = replayWith(commands, effects), standing = replayWith(commands, effects, still);
      ASSERT_FALSE(standing.divergence);
      for (const Signal& signal : moving.simulated.signals)
        if (signal.name.starts_with("pressure_")) {
          EXPECT_EQ(signal.values, valuesOf(standing, signal.name)) << signal.name;
        }
      EXPECT_NE(valuesOf(moving, "length_0_mm"), valuesOf(standing, "length_0_mm"));
      ++compared_count;
    }
  }
  EXPECT_GE(compared_count, 20);
}

std::vector<std::string> allIds() {
  std::vector<std::string> ids;
  for (const EffectInfo& info : effectCatalogue()) ids.push_back(info.id);
  for (const OutOfCatalogueLaw& foreign : outOfCatalogueLaws()) ids.push_back(foreign.info.id);
  return ids;
}

std::string testName(const ::testing::TestParamInfo<std::string>& place) {
  std::string name = place.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffect, ::testing::ValuesIn(allIds()), testName);

}  // namespace
}  // namespace musclesim
