/// A stop that is never reached changes no effect: effects refer to the force law's lengths, not to the longest and shortest ones.
#include <algorithm>

#include "effect_runs.h"

namespace musclesim {
namespace {

/// All numbers at the upper end of what is usual, so that shapes matter too; the force law has the model's own rest length.
ActiveEffect strongEffect(const EffectInfo& info, const std::string& component) {
  std::vector<double> values;
  for (const EffectParameter& p : info.parameters) values.push_back(p.name == "rest_length_mm" ? 0 : p.usual_high);
  return activeEffect(info, component, values);
}

/// The wrist's muscles stay between 170 and 230 mm; their law has lengths of its own.
ReplayResult runOfWrist(double shortest_mm, double longest_mm, const std::vector<ActiveEffect>& effects) {
  Recording recording = commandsFor("wrist", 0.3, [](double t) { return t < 0.1 ? Action{0.3, 0.5} : Action{0.7, 0.2}; });
  recording.info.robot_parameters = {{"minimum_length_mm", shortest_mm},
                                     {"maximum_length_mm", longest_mm},
                                     {"muscle.model", std::string("line")},
                                     {"force_law.minimum_length_ratio", 0.55}};
  ReplayOptions options;
  options.substeps = 10;  // as many as the model asks for depend on the stops
  return replayWith(recording, effects, options);
}

double largestDifference(const ReplayResult& a, const ReplayResult& b) {
  double largest = 0;
  for (const SignalError& error : compareSignals(a.simulated, b.simulated)) largest = std::max(largest, error.largest);
  return largest;
}

constexpr double settling_accuracy = 1e-8;  ///< of the rest position, in the units of the signals

class EffectBetweenStops : public testing::TestWithParam<std::string> {};

TEST_P(EffectBetweenStops, IsTheSameWhereverTheyAre) {
  const EffectInfo info = effectInfo(GetParam());
  Simulation simulation;
  const std::vector<std::string> components = componentsFor(info, simulation.build("wrist"));
  if (components.empty()) GTEST_SKIP() << "the wrist has no such component";
  const std::vector<ActiveEffect> effects = {strongEffect(info, components.front())};
  const ReplayResult near = runOfWrist(120, 240, effects), far = runOfWrist(90, 400, effects);
  ASSERT_FALSE(near.divergence) << *near.divergence;
  const auto [shortest, longest] = std::ranges::minmax(valuesOf(near, "length_0_mm"));
  EXPECT_GT(shortest, 120);
  EXPECT_LT(longest, 240);
  EXPECT_LT(largestDifference(near, far), settling_accuracy);
}

std::vector<std::string> idsOfCatalogue() {
  std::vector<std::string> ids;
  for (const EffectInfo& info : effectCatalogue()) ids.push_back(info.id);
  return ids;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EffectBetweenStops, testing::ValuesIn(idsOfCatalogue()), [](const auto& place) { return place.param; });

TEST(UnreachedStops, DoNotChangeAnyOtherForceLaw) {
  for (const char* law : {"braun", "chou-hannaford", "sarosi", "map"}) {
    const std::vector<ActiveEffect> effects = {{"force_law", "all", {{"law", law}}}};
    EXPECT_LT(largestDifference(runOfWrist(120, 240, effects), runOfWrist(90, 400, effects)), settling_accuracy) << law;
  }
}

TEST(UnreachedStops, StrongEffectsAreFelt) {
  const ReplayResult clean = runOfWrist(120, 240, {});
  for (const char* id : {"creep", "braid_hysteresis", "volume_coupling", "force_law"})
    EXPECT_GT(largestDifference(clean, runOfWrist(120, 240, {strongEffect(effectInfo(id), "all")})), 0.01) << id;
}

}  // namespace
}  // namespace musclesim
