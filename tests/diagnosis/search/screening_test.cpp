// With many muscles, most hypotheses are screened on the first recording only.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "../planted.h"
#include "diagnosis/model/plant.h"
#include "diagnosis/search/search.h"
#include "musclesim/base/random.h"

namespace musclesim {
namespace {

/// An arm with massless muscles, which are fast, under steps of all commands.
Recording armRecorded(const std::vector<ActiveEffect>& effects, std::uint64_t seed) {
  constexpr int muscle_count = 10, row_count = 60, rows_per_step = 20;
  constexpr double noise = 0.05;
  Recording plan;
  plan.file = "arm_" + std::to_string(seed) + ".csv";
  plan.info.robot = "arm";
  plan.info.robot_parameters = {{"muscle.model", std::string("line")}};
  RandomStream random(seed, "arm");
  for (int muscle = 0; muscle < muscle_count; ++muscle) {
    Signal& command = plan.signals.emplace_back(Signal{"command_" + std::to_string(muscle), {}});
    double level = 0;
    for (int row = 0; row < row_count; ++row) {
      if (row % rows_per_step == 0) level = 0.2 + 0.5 * random.uniform();
      command.values.push_back(level);
    }
  }
  for (int row = 0; row < row_count; ++row) plan.time_s.push_back(0.01 * row);
  ReplayOptions options;
  options.effects = effects;
  Recording recording = replayRecording(plan, options).simulated;
  recording.file = plan.file;
  recording.info.active_effects.clear();
  std::erase_if(recording.signals, [](const Signal& s) { return !s.name.starts_with("command_") && !s.name.starts_with("length_"); });
  for (Signal& signal : recording.signals) {
    if (signal.name.starts_with("command_")) continue;
    recording.info.noise_std[signal.name] = noise;
    for (double& value : signal.values) value += noise * random.normal();
  }
  return recording;
}

bool wasScreened(const Sensitivity& sensitivity) {
  return std::ranges::all_of(sensitivity.per_strength, [](const SharedVector& change) { return change != nullptr; });
}

class ScreeningOfHypotheses : public ::testing::Test {
 protected:
  static const std::vector<Recording>& weakMuscle() {
    static const std::vector<Recording> all = [] {
      const std::vector<ActiveEffect> weak = {{"force_gain", "muscle_3", {{"gain", 0.97}}}};
      return std::vector<Recording>{armRecorded(weak, 1), armRecorded(weak, 2), armRecorded(weak, 3)};
    }();
    return all;
  }
  struct Screened : ScreenedCatalogue {
    std::vector<Hypothesis> hypotheses;
  };
  static Screened screened(const std::vector<Recording>& recordings, const DiagnosisOptions& options) {
    const Plant plant(recordings, options);
    Search search(plant, options, [] {});
    search.screen();
    return {search.catalogue(), search.hypotheses()};
  }
};

TEST_F(ScreeningOfHypotheses, OfManyMusclesKeepsTheNearestAndEveryEffect) {
  const Screened screening = screened(weakMuscle(), planted::few({}));
  EXPECT_LT(screening.screened_count, screening.hypotheses.size() / 2);
  std::size_t count = 0;
  std::set<std::string> effects, all_effects;
  std::size_t best = 0;
  for (std::size_t i = 0; i < screening.hypotheses.size(); ++i) {
    if (screening.sensitivities[i].misfit < screening.sensitivities[best].misfit) best = i;
    all_effects.insert(screening.hypotheses[i].info().id);
    if (screening.hypotheses[i].component() == "all") {
      EXPECT_TRUE(wasScreened(screening.sensitivities[i])) << screening.hypotheses[i].label();
    }
    if (!wasScreened(screening.sensitivities[i])) continue;
    ++count;
    effects.insert(screening.hypotheses[i].info().id);
  }
  EXPECT_EQ(count, screening.screened_count);
  EXPECT_EQ(effects, all_effects);
  EXPECT_EQ(screening.hypotheses[best].component(), "muscle_3") << screening.hypotheses[best].label();
}

TEST_F(ScreeningOfHypotheses, DoesNotDependOnWhatMayBeAnAnswer) {
  const Screened all = screened(weakMuscle(), planted::few({})), creep = screened(weakMuscle(), planted::few({"creep"}));
  ASSERT_EQ(all.sensitivities.size(), creep.sensitivities.size());
  for (std::size_t i = 0; i < all.sensitivities.size(); ++i) EXPECT_EQ(all.sensitivities[i].misfit, creep.sensitivities[i].misfit);
}

TEST_F(ScreeningOfHypotheses, OfFewMusclesTakesAll) {
  const Screened screening = screened(planted::plant({{"payload", "hand", {{"mass_kg", 0.2}}}}), planted::few({}));
  EXPECT_EQ(screening.screened_count, screening.hypotheses.size());
}

/// A command between two values, each for a quarter of a second.
Recording betweenTwo(const std::vector<ActiveEffect>& effects, double low, double high, std::uint64_t seed) {
  Recording plan;
  plan.file = "two_" + std::to_string(seed) + ".csv";
  plan.info.robot = "rig";
  plan.signals = {{"command_0", {}}};
  for (int row = 0; row < 150; ++row) {
    plan.time_s.push_back(0.01 * row);
    plan.signals[0].values.push_back(row / 25 % 2 == 0 ? low : high);
  }
  return planted::measuredUnder(effects, plan, seed);
}

/// The levels of the first recording are exact with five bits as well as with six to ten; only the other recordings distinguish them.
class NumbersOfBits : public ScreeningOfHypotheses, public testing::WithParamInterface<double> {};
INSTANTIATE_TEST_SUITE_P(Look, NumbersOfBits, testing::Values(6.0, 9.0));
TEST_P(NumbersOfBits, AreChosenByAllRecordingsOfTheLook) {
  const ActiveEffect effect{"command_quantisation", "muscle_0", {{"bits", GetParam()}, {"rounding_point", 0.5}, {"top_level", 0.0}}};
  const std::vector<ActiveEffect> quantised = {effect};
  const std::vector<Recording> recordings = {betweenTwo(quantised, 10.0 / 32, 15.0 / 32, 1), betweenTwo(quantised, 20.4 / 64, 30.7 / 64, 2),
                                             betweenTwo(quantised, 21.3 / 64, 29.2 / 64, 3), planted::recorded(quantised, 0.1, 4)};
  const Screened screening = screened(recordings, planted::few({}));
  std::vector<double> bits;
  for (const Hypothesis& hypothesis : screening.hypotheses)
    if (hypothesis.info().id == "command_quantisation" && hypothesis.component() == "muscle_0")
      for (const auto& [name, value] : hypothesis.valuesAt({}))
        if (name == "bits") bits.push_back(value);
  ASSERT_EQ(bits.size(), 2u);
  EXPECT_TRUE(std::ranges::find(bits, GetParam()) != bits.end()) << bits[0] << ", " << bits[1];
}

}  // namespace
}  // namespace musclesim
