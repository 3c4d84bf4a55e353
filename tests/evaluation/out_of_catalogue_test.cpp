/// The laws outside the catalogue stay apart from the catalogue, and there is one for every effect.
#include "evaluation/out_of_catalogue/out_of_catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "effect/effect_runs.h"
#include "support/out_of_catalogue_laws.h"

namespace musclesim {
namespace {

TEST(OutOfCatalogue, IsNeverInTheCatalogue) {
  for (const EffectInfo& info : effectCatalogue()) EXPECT_FALSE(info.id.starts_with("foreign.")) << info.id;
  std::set<std::string> ids;
  for (const OutOfCatalogueLaw& foreign : outOfCatalogueLaws()) {
    EXPECT_TRUE(foreign.info.id.starts_with("foreign."));
    EXPECT_TRUE(ids.insert(foreign.info.id).second) << foreign.info.id;
    EXPECT_EQ(effectInfo(foreign.info.id).id, foreign.info.id);
  }
}

TEST(OutOfCatalogue, HasALawForEveryEffectAndSixCausesMore) {
  std::set<std::string> covered;
  int open_count = 0;
  for (const OutOfCatalogueLaw& foreign : outOfCatalogueLaws()) {
    if (foreign.stands_for.empty()) {
      ++open_count;
      continue;
    }
    EXPECT_EQ(foreign.info.stage, effectInfo(foreign.stands_for).stage) << foreign.info.id;
    covered.insert(foreign.stands_for);
  }
  EXPECT_GE(open_count, 6);
  for (const EffectInfo& info : effectCatalogue()) {
    if (info.id == "misplaced") continue;  // registered by another test
    EXPECT_TRUE(covered.contains(info.id)) << info.id;
  }
}

/// For effects that only a rig can have: a load on a guide.
Recording rigCommands() {
  return commandsFor("rig", 0.5, [](double t) { return Action{0.3 + 0.2 * std::sin(7 * t)}; });
}

Recording elbowCommands() {
  return commandsFor("elbow", 0.5, [](double t) {
    return Action{0.1 + 0.7 * std::min(1.0, 2 * std::abs(std::sin(7 * t))), 0.15 + 0.1 * t};
  });
}

double largestDifference(const ReplayResult& one, const ReplayResult& other) {
  double largest = 0;
  for (const SignalError& error : compareSignals(one.simulated, other.simulated)) largest = std::max(largest, error.largest);
  return largest;
}

/// The same parameters, as far as both laws have them, give another motion or reading: the law is not the catalogue's.
TEST(OutOfCatalogue, IsAnotherLaw) {
  const Recording elbow_commands = elbowCommands(), rig_commands = rigCommands();
  Simulation elbow, rig;
  const Robot &elbow_robot = elbow.build("elbow"), &rig_robot = rig.build("rig");
  for (const OutOfCatalogueLaw& foreign : outOfCatalogueLaws()) {
    if (foreign.stands_for.empty()) continue;
    const EffectInfo own = effectInfo(foreign.stands_for);
    const bool on_elbow = !componentsFor(own, elbow_robot).empty();
    const Recording& commands = on_elbow ? elbow_commands : rig_commands;
    const std::string component = componentsFor(own, on_elbow ? elbow_robot : rig_robot).front();
    std::vector<double> values;
    for (const EffectParameter& p : foreign.info.parameters) values.push_back(p.shape ? p.neutral : p.usual_high);
    ActiveEffect truth = activeEffect(foreign.info, component, values), candidate{own.id, component, {}};
    for (const EffectParameter& p : own.parameters)
      if (truth.parameters.contains(p.name)) candidate.parameters[p.name] = truth.parameters[p.name];
    const ReplayResult one = replayWith(commands, {truth}), other = replayWith(commands, {candidate});
    EXPECT_GT(largestDifference(one, other), 1e-3) << foreign.info.id;
  }
}

TEST(OutOfCatalogue, EveryCauseOfItsOwnShows) {
  const Recording commands = elbowCommands();
  Simulation probe;
  const Robot& robot = probe.build("elbow");
  const ReplayResult without = replayWith(commands, {});
  for (const OutOfCatalogueLaw& foreign : outOfCatalogueLaws()) {
    if (!foreign.stands_for.empty()) continue;
    std::vector<double> values;
    for (const EffectParameter& p : foreign.info.parameters) values.push_back(p.shape ? p.neutral : p.usual_high);
    const ActiveEffect cause = activeEffect(foreign.info, componentsFor(foreign.info, robot).front(), values);
    EXPECT_GT(largestDifference(without, replayWith(commands, {cause})), 1e-3) << foreign.info.id;
  }
}

}  // namespace
}  // namespace musclesim
