// The search over sets of causes, on rigs whose causes are known.
#include "diagnosis/search/search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../planted.h"

namespace musclesim {
namespace {

using Labels = std::set<std::string>;

/// The search on three recordings of a rig with these effects.
struct Searched {
  Searched(const std::vector<ActiveEffect>& effects, const std::vector<std::string>& candidates, planted::Pressure pressure, int job_count)
      : options(planted::few(candidates)),
        plant({planted::recorded(effects, 0.15, 1, pressure), planted::recorded(effects, 0.1, 3, pressure),
               planted::recorded(effects, 0.2, 2, pressure)},
              options) {
    options.job_count = job_count;
    options.max_effects = 4;
    search.screen();
    search.decide();
  }
  /// The most probable explanation, and no effect.
  Labels best() const {
    if (search.explanations().empty() || search.explanations().front().probability < search.nothing().probability) return {};
    return search.causes().labelsOf(search.explanations().front().members);
  }
  /// Value of a parameter of an effect of the most probable explanation.
  double valueOf(const std::string& id, const std::string& parameter) const {
    for (const ActiveEffect& effect : search.modelOf(search.explanations().front()).effects)
      if (effect.id == id) return std::get<double>(effect.parameters.at(parameter));
    return NAN;
  }
  /// How probabilities and causes read, for messages.
  std::string words() const {
    std::string result = "nothing " + std::to_string(search.nothing().probability) + "\n";
    for (const Explanation& explanation : search.explanations()) {
      for (const std::string& label : search.causes().labelsOf(explanation.members)) result += label + " ";
      result += std::to_string(explanation.probability) + "\n";
    }
    return result;
  }
  DiagnosisOptions options;
  Plant plant;
  Search search{plant, options, [] {}};
};

const ActiveEffect delay{"transport_delay", "muscle_0", {{"delay_s", 0.03}}};
const ActiveEffect lag{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.05}, {"vent_time_constant_s", 0.08}}};
const std::vector<std::string> late = {"transport_delay", "valve_lag", "sensor_delay", "viscous_loss", "force_gain"};

TEST(Search, FindsTwoCausesThatLookAlike) {
  const Searched two({delay, lag}, late, planted::Pressure::measured, 2);
  ASSERT_EQ(two.best(), (Labels{"transport_delay@muscle_0", "valve_lag@muscle_0"})) << two.words();
  EXPECT_NEAR(two.valueOf("transport_delay", "delay_s"), 0.03, 0.003);
  EXPECT_NEAR(two.valueOf("valve_lag", "fill_time_constant_s"), 0.05, 0.005);
  EXPECT_NEAR(two.valueOf("valve_lag", "vent_time_constant_s"), 0.08, 0.008);
  EXPECT_LT(two.search.somethingElse(), 0.1);
  const std::vector<Explanation> singles = two.search.singles();
  ASSERT_FALSE(singles.empty());
  for (const Explanation& single : singles) EXPECT_EQ(single.members.size(), 1U);
  double sum = two.search.nothing().probability, last = 1;
  for (const Explanation& explanation : two.search.explanations()) {
    EXPECT_LE(explanation.probability, last) << two.words();
    EXPECT_FALSE(explanation.members.empty());
    last = explanation.probability;
    sum += explanation.probability;
  }
  EXPECT_NEAR(sum, 1, 1e-9);
}

/// A leak has the lag of its regulator and stands in for the valve's lag; the set of the two true causes must be found beside it.
TEST(Search, FindsTheStandInOfAMember) {
  const ActiveEffect loop{"braid_hysteresis", "muscle_0", {{"relative_width", 0.06}, {"presliding_mm", 0.7}}};
  const Searched two({loop, lag}, {"braid_hysteresis", "leak", "valve_lag", "volume_coupling"}, planted::Pressure::measured, 2);
  EXPECT_EQ(two.best(), (Labels{"braid_hysteresis@muscle_0", "valve_lag@muscle_0"})) << two.words();
}

TEST(Search, OfOneCauseFindsOne) {
  const Searched one({lag}, late, planted::Pressure::measured, 2);
  ASSERT_EQ(one.best(), Labels{"valve_lag@muscle_0"}) << one.words();
  EXPECT_NEAR(one.valueOf("valve_lag", "fill_time_constant_s"), 0.05, 0.003);
  EXPECT_GT(one.search.explanations().front().probability, 0.8) << one.words();
  EXPECT_LT(one.search.somethingElse(), 0.1);
}

/// The load is 3 % off; the robot's file says that it may be off by 2 %, and its force law by 5 %.
TEST(Search, TakesALoadThatIsOffForNoEffect) {
  const Searched heavier({{"payload", "hand", {{"mass_kg", 0.06}}}}, {"valve_lag", "transport_delay"}, planted::Pressure::left_out, 2);
  EXPECT_EQ(heavier.best(), Labels{}) << heavier.words();
  const Explanation& nothing = heavier.search.nothing();
  EXPECT_GT(nothing.probability, 0.5) << heavier.words();
  for (const Explanation& explanation : heavier.search.explanations())
    EXPECT_LT(explanation.probability, nothing.probability / 2) << heavier.words();
  const Comparison& comparison = heavier.search.fitComparison();
  EXPECT_LT(comparison.misfit(nothing.residual), 0.1 * comparison.misfit(heavier.search.nominalResidual()));
  EXPECT_LT(nothing.numbers.cwiseAbs().maxCoeff(), 2) << "tolerances";
  for (const auto& [name, value] : heavier.plant.numbersAt(nothing.numbers))
    if (name == "rig.load_kg") {
      EXPECT_GT(value, 2) << "heavier";
    }
}

/// A fit without effects made 12 kg of a load of 2 kg.
TEST(Search, ComesBackToTheGivenValueOfATunedNumber) {
  DiagnosisOptions options = planted::few({"valve_lag", "force_gain"});
  options.tune = {"rig.load_kg"};
  options.model.parameters.set("rig.load_kg", 12.0, "--tune");
  const Plant plant(planted::withExactModel(planted::plant({lag})), options, {{"rig.load_kg", 2.0}});
  Search search(plant, options, [] {});
  search.screen();
  search.decide();
  const Explanation& best = search.explanations().front();
  EXPECT_EQ(search.causes().labelsOf(best.members), Labels{"valve_lag@muscle_0"});
  EXPECT_NEAR(plant.numberAt(0, best.numbers[0]), 2, 0.02);
}

TEST(Search, GivesTheSameBitsWithOneAndTwoThreads) {
  const std::vector<std::string> few = {"transport_delay", "valve_lag"};
  const Searched one({delay, lag}, few, planted::Pressure::left_out, 1), two({delay, lag}, few, planted::Pressure::left_out, 2);
  const auto &of_one = one.search.explanations(), &of_two = two.search.explanations();
  ASSERT_EQ(of_one.size(), of_two.size());
  ASSERT_FALSE(of_one.empty());
  for (std::size_t i = 0; i < of_one.size(); ++i) {
    EXPECT_EQ(of_one[i].members, of_two[i].members);
    EXPECT_EQ(of_one[i].z, of_two[i].z);
    EXPECT_EQ(of_one[i].numbers, of_two[i].numbers);
    EXPECT_EQ(of_one[i].probability, of_two[i].probability);
  }
  EXPECT_EQ(one.search.somethingElse(), two.search.somethingElse());
}

/// Recordings of the length of one muscle of a robot of lines, 0.6 s each.
std::vector<Recording> lineRecordings(const std::string& robot, int muscle_count, const std::vector<std::string>& files,
                                      const std::vector<ActiveEffect>& effects, double length_gain) {
  Recording plan;
  plan.info.robot = robot;
  plan.info.robot_parameters = {{"muscle.model", std::string("line")}};
  for (int muscle = 0; muscle < muscle_count; ++muscle) {
    Signal& command = plan.signals.emplace_back(Signal{"command_" + std::to_string(muscle), {}});
    for (int row = 0; row < 60; ++row) command.values.push_back(row < 20 ? 0.3 : 0.3 + 0.03 * muscle);
  }
  for (int row = 0; row < 60; ++row) plan.time_s.push_back(0.01 * row);
  ReplayOptions options;
  options.effects = effects;
  std::vector<Recording> recordings;
  for (const std::string& file : files) {
    for (Signal& command : plan.signals)
      for (double& value : command.values) value += 0.03;
    recordings.push_back(replayRecording(plan, options).simulated);
    recordings.back().file = file;
    std::erase_if(recordings.back().signals, [](const Signal& s) { return !s.name.starts_with("command_") && s.name != "length_3_mm"; });
    recordings.back().info.noise_std = {{"length_3_mm", 0.05}};
    recordings.back().info.active_effects.clear();
    for (double& value : recordings.back().signals.back().values) value *= length_gain;
  }
  return recordings;
}

/// The arm knows no tolerances.
TEST(Search, NeedsNoNumbersWithATolerance) {
  const Diagnosis found =
      diagnose(lineRecordings("arm", 10, {"first.csv", "second.csv"}, {}, 1.02), planted::few({"sensor_gain", "force_gain"}));
  EXPECT_EQ(found.chosen, std::vector<std::string>{"sensor_gain@signal_length_3"}) << diagnosisSummary(found);
  EXPECT_TRUE(found.numbers.empty());
}

/// Of many hypotheses only some are screened on all segments; a set may have a member that was not.
TEST(Search, GoesOnFromAnEffectThatWasNotScreened) {
  const ActiveEffect slow{"flow_limit", "muscle_3", {{"fill_rate_per_s", 0.4}, {"vent_rate_per_s", 0.4}}};
  DiagnosisOptions options = planted::few({"flow_limit"});
  options.earlier = {{"flow_limit", "muscle_0", {{"fill_rate_per_s", 1.0}, {"vent_rate_per_s", 1.0}}}};
  const Plant plant(lineRecordings("pulley_arm", 6, {"first.csv", "second.csv", "third.csv"}, {slow}, 1), options);
  Search search(plant, options, [] {});
  search.screen();
  const auto earlier = std::ranges::find(search.hypotheses(), "flow_limit@muscle_0", &Hypothesis::label) - search.hypotheses().begin();
  ASSERT_EQ(search.catalogue().sensitivities.at(static_cast<std::size_t>(earlier)).per_strength.front(), nullptr);
  search.decide();
  EXPECT_EQ(search.causes().labelsOf(search.explanations().front().members), Labels{"flow_limit@muscle_3"});
}

/// A leak takes part in the balance of the lag. Were its air replaced by a regulator of its own, a leak of one muscle beside a lag of all
/// would be a second lag of that muscle.
TEST(Search, FindsALeakOfOneMuscleBesideALagOfAll) {
  const std::vector<ActiveEffect> planted = {{"valve_lag", "all", {{"fill_time_constant_s", 0.12}, {"vent_time_constant_s", 0.12}}},
                                             {"leak", "muscle_1", {{"leak_per_s", 0.8}}}};
  std::vector<Recording> recordings;
  for (const double amplitude : {0.05, 0.08, 0.06}) {
    Recording plan;
    plan.info.robot = "elbow";
    plan.info.robot_parameters = {{"muscle.model", std::string("line")}};
    plan.signals = {{"command_0", {}}, {"command_1", {}}};
    for (int row = 0; row < 300; ++row) {
      const double t = 0.01 * row, way = amplitude * (t < 1.5 ? std::sin(4 * t) : std::fmod(t, 0.8) < 0.4 ? 1 : -1);
      plan.time_s.push_back(t);
      plan.signals[0].values.push_back(0.4 + way);
      plan.signals[1].values.push_back(0.4 - way);
    }
    ReplayOptions options;
    options.effects = planted;
    Recording recording = replayRecording(plan, options).simulated;
    recording.file = "elbow_" + std::to_string(recordings.size()) + ".csv";
    recording.info.active_effects.clear();
    recording.info.noise_std = {{"pressure_0", 0.002}, {"pressure_1", 0.002}, {"angle_elbow_deg", 0.05}};
    std::erase_if(recording.signals,
                  [&](const Signal& s) { return !s.name.starts_with("command_") && !recording.info.noise_std.contains(s.name); });
    for (Signal& signal : recording.signals) {
      const auto noise = recording.info.noise_std.find(signal.name);
      RandomStream random(recordings.size(), signal.name);
      for (double& value : signal.values) value += noise == recording.info.noise_std.end() ? 0 : noise->second * random.normal();
    }
    recordings.push_back(std::move(recording));
  }
  const Diagnosis found = diagnose(recordings, planted::few({"valve_lag", "leak", "force_gain", "sensor_gain", "transport_delay"}));
  ASSERT_EQ(std::set(found.chosen.begin(), found.chosen.end()), (Labels{"leak@muscle_1", "valve_lag@all"})) << diagnosisSummary(found);
  for (const FoundEffect& effect : found.effects) {
    if (effect.label() == "leak@muscle_1") {
      EXPECT_NEAR(effect.parameters.at("leak_per_s").value, 0.8, 0.15);
    }
    if (effect.label() == "valve_lag@all") {
      EXPECT_NEAR(effect.parameters.at("fill_time_constant_s").value, 0.12, 0.006);
    }
  }
}

}  // namespace
}  // namespace musclesim
