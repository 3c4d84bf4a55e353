/// Halving the internal step changes the result of an effect only a little.
#include <map>

#include "effect_runs.h"

namespace musclesim {
namespace {

class Halving : public ::testing::TestWithParam<std::string> {};

double noiseLike(const std::string& signal) {
  if (signal.starts_with("pressure_")) return 0.004;
  if (signal.starts_with("angle_")) return 0.3;
  return signal.starts_with("force_") ? 0.3 : 1.0;  // N, mm
}

/// Largest change of any signal between two runs, in units of noiseLike.
double changeOf(const Recording& a, const Recording& b) {
  double largest = 0;
  for (const SignalError& error : compareSignals(a, b)) largest = std::max(largest, error.rmse / noiseLike(error.name));
  return largest;
}

TEST_P(Halving, ChangesLittle) {
  const EffectInfo info = effectInfo(GetParam());
  Simulation elbow, rig;
  std::string robot = "elbow";
  std::vector<std::string> components = componentsFor(info, elbow.build(robot));
  if (components.empty()) components = componentsFor(info, rig.build(robot = "rig"));
  std::vector<double> values;
  for (const EffectParameter& p : info.parameters)
    values.push_back(p.shape || !p.choices.empty() ? p.neutral : (p.usual_low + p.usual_high) / 2);
  const ActiveEffect effect = activeEffect(info, components.front(), values);
  const Recording commands = commandsFor(robot, 1.0, [&](double t) {
    Action action = {0.4 + 0.1 * std::sin(6 * t), 0.4 + 0.1 * std::sin(5 * t + 1)};
    if (robot == "rig") action.pop_back();
    return action;
  });
  auto run = [&](int substeps) {
    ReplayOptions options;
    options.substeps = substeps;
    return replayWith(commands, {effect}, options).simulated;
  };
  constexpr int usual = 34;
  EXPECT_LT(changeOf(run(usual), run(2 * usual)), 0.5);
}

std::vector<std::string> catalogueIds() {
  std::vector<std::string> ids;
  for (const EffectInfo& info : effectCatalogue()) ids.push_back(info.id);
  return ids;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Halving, ::testing::ValuesIn(catalogueIds()), [](const auto& place) { return place.param; });

}  // namespace
}  // namespace musclesim
