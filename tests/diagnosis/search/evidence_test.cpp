// How believable fitted explanations are.
#include "diagnosis/search/evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "../planted.h"
#include "../tempered_misfit.h"

namespace musclesim {
namespace {

/// Residuals are constant: the model without effects leaves 20 sigmas. One segment of one signal has a power of 3.
class EvidenceOnARig : public testing::Test {
 protected:
  enum Index : std::size_t { payload, bias, gain, threshold, bits };
  static constexpr double gap = 20, power = 3;

  EvidenceOnARig() {
    causes_.hypotheses = {{effectInfo("payload"), "hand", plant_},
                          {effectInfo("sensor_bias"), "signal_length_0", plant_},
                          {effectInfo("force_gain"), "muscle_0", plant_},
                          {effectInfo("threshold_pressure"), "muscle_0", plant_}};
    const Hypothesis counted(effectInfo("command_quantisation"), "muscle_0", plant_);
    causes_.hypotheses.push_back(counted.variants(plant_).front());
    comparison_.setGap(nominal_);
  }

  Eigen::VectorXd leaving(double sigmas) const { return Eigen::VectorXd::Constant(comparison_.size(), sigmas * planted::noise_mm); }

  Explanation fitted(const std::vector<std::size_t>& members, double sigmas, double z = 0.1) const {
    Explanation result;
    result.members = members;
    result.residual = leaving(sigmas);
    Eigen::Index count = 0;
    for (const std::size_t member : members) count += causes_.hypotheses[member].coordinateCount();
    result.z = Eigen::VectorXd::Constant(count, z);
    return result;
  }

  double ofSingle(std::size_t member, double sigmas) const { return evidence_.score(fitted({member}, sigmas)); }
  double priceOf(const std::vector<std::size_t>& members, double z = 0.1) const { return evidence_.price(fitted(members, 1, z)); }

  DiagnosisOptions options_;
  OnSimulation on_simulation_ = [] {};
  Plant plant_{planted::plant({}), options_};
  Comparison comparison_{plant_, {{0, 0, 400}}};
  Causes causes_{plant_, on_simulation_};
  Eigen::VectorXd nominal_ = leaving(gap);
  Evidence evidence_{comparison_, nominal_, causes_};
};

TEST_F(EvidenceOnARig, FollowsWhatIsLeft) {
  for (const double sigmas : {0.5, 1.0, 2.0, 5.0, 10.0})
    EXPECT_NEAR(ofSingle(payload, sigmas), -power * temperedMisfit(sigmas, gap) - prices.parameters, 1e-9) << sigmas;
  EXPECT_GT(ofSingle(payload, 2) - ofSingle(payload, 4), 2 * (ofSingle(payload, 0.5) - ofSingle(payload, 1)))
      << "what is left below the noise says little";
}

TEST_F(EvidenceOnARig, NoEffectCostsNothing) {
  EXPECT_EQ(evidence_.price(fitted({}, 1)), 0);
  EXPECT_NEAR(evidence_.score(fitted({}, gap)), -power * temperedMisfit(gap, gap), 1e-9);
}

TEST_F(EvidenceOnARig, CountsParameters) {
  ASSERT_EQ(causes_.hypotheses[gain].coordinateCount(), 1);
  ASSERT_EQ(causes_.hypotheses[threshold].coordinateCount(), 2);
  EXPECT_NEAR(priceOf({gain}), prices.parameters, 1e-12);
  EXPECT_NEAR(priceOf({threshold}), 2 * prices.parameters, 1e-12);
  ASSERT_EQ(causes_.hypotheses[bits].coordinateCount(), 0);
  EXPECT_NEAR(priceOf({bits}), static_cast<double>(effectInfo("command_quantisation").parameters.size()) * prices.parameters, 1e-12)
      << "numbers that were tried one by one count as fitted ones";
}

TEST_F(EvidenceOnARig, WhatTheDataDoNotDetermineCostsNothing) {
  Explanation half_known = fitted({threshold}, 1);
  half_known.determined = Eigen::Vector2d(1, 0);
  EXPECT_NEAR(evidence_.price(half_known), prices.parameters, 1e-12);
}

TEST_F(EvidenceOnARig, AFurtherEffectThatGainsNothingCosts) {
  const Explanation alone = fitted({payload}, 2), pair = fitted({payload, bias}, 2);
  EXPECT_NEAR(evidence_.score(alone) - evidence_.score(pair), prices.effects + prices.parameters, 1e-9);
  EXPECT_NEAR(priceOf({payload, bias, gain}), 2 * prices.effects + 3 * prices.parameters, 1e-9) << "the first one is free";
}

TEST_F(EvidenceOnARig, AFurtherEffectInTheSamePlaceCostsMore) {
  EXPECT_NEAR(priceOf({gain, threshold}) - priceOf({gain, bias}), prices.same_place + prices.parameters, 1e-9);
  EXPECT_EQ(priceOf({gain, threshold}), priceOf({threshold, gain}));
}

TEST_F(EvidenceOnARig, ThePriceOfASetDoesNotDependOnItsOrder) {
  Recording plan;
  plan.file = "plan.csv";
  plan.info.robot = "elbow";
  plan.info.robot_parameters["muscle.model"] = std::string("line");
  plan.signals = {{"command_0", {}}, {"command_1", {}}};
  for (int row = 0; row < 60; ++row) {
    plan.time_s.push_back(0.01 * row);
    for (Signal& command : plan.signals) command.values.push_back(0.3 + 0.002 * row);
  }
  Recording recording = replayRecording(plan, {}).simulated;
  recording.file = plan.file;
  const DiagnosisOptions options;
  const Plant elbow({recording}, options);
  const Comparison comparison(elbow, elbow.split().fit);
  Causes causes(elbow, on_simulation_);
  for (const auto& [id, component] : {std::pair{"valve_lag", "all"}, {"creep", "muscle_0"}, {"creep", "muscle_1"}})
    causes.hypotheses.emplace_back(effectInfo(id), component, elbow);
  const Eigen::VectorXd residual = Eigen::VectorXd::Zero(comparison.size());
  const Evidence evidence(comparison, residual, causes);
  std::set<double> prices_of_orders;
  std::vector<std::size_t> members = {0, 1, 2};
  do {
    Explanation explanation;
    explanation.members = members;
    std::vector<double> z;
    for (const std::size_t member : members)
      for (const double one : causes.hypotheses[member].typical()) z.push_back(one);
    explanation.z = Eigen::Map<const Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()));
    prices_of_orders.insert(std::round(1e9 * evidence.price(explanation)));
  } while (std::ranges::next_permutation(members).found);
  EXPECT_EQ(prices_of_orders.size(), 1u);
}

TEST_F(EvidenceOnARig, AFurtherMechanismOfALawCostsLikeAnotherEffectOfItsPlace) {
  Causes lags(plant_, on_simulation_);
  lags.hypotheses = Hypothesis(effectInfo("valve_lag"), "muscle_0", plant_).variants(plant_);
  ASSERT_EQ(lags.hypotheses.size(), 2u);
  ASSERT_EQ(lags.hypotheses[0].furtherMechanisms().size(), 1) << "of the further lags";
  ASSERT_EQ(lags.hypotheses[1].furtherMechanisms().size(), 0);
  const Evidence evidence(comparison_, nominal_, lags);
  const auto priceOf = [&](std::size_t variant) {
    Explanation explanation;
    explanation.members = {variant};
    explanation.z = lags.hypotheses[variant].typical();
    return evidence.price(explanation);
  };
  EXPECT_NEAR(priceOf(0) - priceOf(1), prices.effects + prices.same_place + prices.parameters, 1e-9);
}

TEST_F(EvidenceOnARig, AShapeBeyondItsUsualRangeCosts) {
  const Hypothesis limit(effectInfo("flow_limit"), "muscle_0", plant_);
  const auto& parameters = limit.info().parameters;
  const auto band = std::ranges::find(parameters, "proportional_band", &EffectParameter::name);
  ASSERT_NE(band, parameters.end());
  const auto excessAt = [&](double value) {
    return limit.excess(limit.coordinatesOf({{"fill_rate_per_s", 3.0}, {"vent_rate_per_s", 3.0}, {"proportional_band", value}}));
  };
  const double usual = excessAt(band->usual_high);
  EXPECT_NEAR(excessAt(band->usual_low), usual, 1e-9);
  EXPECT_NEAR(excessAt(2 * band->usual_high) - usual, std::log(2), 1e-9);
  EXPECT_NEAR(excessAt(band->usual_low / 2) - usual, std::log(2), 1e-9);
}

TEST_F(EvidenceOnARig, PlacesOverlapThroughAllAndThroughPairsOfMuscles) {
  Causes on_two(plant_, on_simulation_);
  on_two.hypotheses = {{effectInfo("force_gain"), "muscle_1", plant_},
                       {effectInfo("leak"), "all", plant_},
                       {effectInfo("channel_swap"), "muscle_0+muscle_1", plant_},
                       {effectInfo("leak"), "muscle_10", plant_},
                       {effectInfo("payload"), "hand", plant_},
                       {effectInfo("base_tilt"), "base", plant_},
                       {effectInfo("sensor_bias"), "all", plant_},
                       {effectInfo("sensor_gain"), "signal_length_0", plant_},
                       {effectInfo("sensor_bias"), "signal_angle_elbow", plant_}};
  const Evidence evidence(comparison_, nominal_, on_two);
  const auto priceOf = [&](const std::vector<std::size_t>& members) {
    Explanation explanation;
    explanation.members = members;
    Eigen::Index count = 0;
    for (const std::size_t member : members) count += on_two.hypotheses[member].coordinateCount();
    explanation.z = Eigen::VectorXd::Zero(count);
    return evidence.price(explanation);
  };
  const auto forPlace = [&](std::size_t one, std::size_t other) {
    return priceOf({one, other}) - priceOf({one}) - priceOf({other}) - prices.effects;
  };
  EXPECT_NEAR(forPlace(0, 1), prices.same_place, 1e-9) << "a muscle and all";
  EXPECT_NEAR(forPlace(0, 2), prices.same_place, 1e-9) << "a muscle and a pair with it";
  EXPECT_NEAR(forPlace(4, 5), prices.same_place, 1e-9) << "both on the body";
  EXPECT_NEAR(forPlace(6, 7), prices.same_place, 1e-9) << "all sensors and one of them";
  EXPECT_NEAR(forPlace(0, 3), 0, 1e-9) << "another muscle";
  EXPECT_NEAR(forPlace(0, 4), 0, 1e-9) << "the body";
  EXPECT_NEAR(forPlace(1, 6), 0, 1e-9) << "all sensors are no muscle";
  EXPECT_NEAR(forPlace(7, 8), 0, 1e-9) << "another sensor";
  EXPECT_NEAR(priceOf({0, 1, 2}) - priceOf({0}) - priceOf({1}) - priceOf({2}), 2 * (prices.effects + prices.same_place), 1e-9)
      << "each further effect pays once";
  EXPECT_NEAR(priceOf({6}) - priceOf({8}), prices.shared_sensor, 1e-9) << "a fault that all sensors share";
}

/// A rig's muscle is the only one; an elbow has two, of which one may leak alone, or both.
TEST_F(EvidenceOnARig, ComponentsShareThePriorOfAnEffect) {
  std::vector<Recording> recordings = planted::plant({});
  for (Recording& recording : recordings) {
    recording.info = {};
    recording.info.robot = "elbow";
    recording.info.noise_std = {{"angle_elbow_deg", 0.05}};
    const std::vector<double> command = recording.signals[0].values;
    recording.signals = {{"command_0", command}, {"command_1", command}, {"angle_elbow_deg", recording.signals[1].values}};
  }
  DiagnosisOptions options;
  options.candidates = {"leak", "payload"};
  const Plant elbow(recordings, options);
  Causes causes(elbow, on_simulation_);
  causes.hypotheses = hypotheses(elbow, options);
  const Evidence evidence(comparison_, nominal_, causes);
  std::map<std::string, double> places;
  for (std::size_t i = 0; i < causes.hypotheses.size(); ++i) {
    Explanation explanation;
    explanation.members = {i};
    explanation.z = Eigen::VectorXd::Zero(causes.hypotheses[i].coordinateCount());
    places[causes.hypotheses[i].label()] = evidence.complexityOf(explanation).places;
  }
  EXPECT_NEAR(places.at("leak@muscle_0"), std::log(2), 1e-12);
  EXPECT_NEAR(places.at("leak@muscle_1"), std::log(2), 1e-12);
  EXPECT_EQ(places.at("leak@all"), 0);
  EXPECT_EQ(places.at("payload@hand"), 0);
}

/// A payload is usually up to 1 kg.
TEST_F(EvidenceOnARig, WhatExceedsItsUsualRangeCosts) {
  const EffectParameter& mass = effectInfo("payload").parameters.front();
  const double largest_kg = std::max(std::abs(mass.usual_low), std::abs(mass.usual_high));
  const Hypothesis& hypothesis = causes_.hypotheses[payload];
  const double per_z_kg = hypothesis.valuesAt(Eigen::VectorXd::Constant(1, 1)).front().second;
  EXPECT_NEAR(priceOf({payload}, 0.99 * largest_kg / per_z_kg), prices.parameters, 1e-9);
  EXPECT_NEAR(priceOf({payload}, std::numbers::e * largest_kg / per_z_kg), prices.parameters + prices.excess, 1e-9);
}

/// A ninth of the force is as many e-folds of a usual factor as its logarithm has.
TEST_F(EvidenceOnARig, FactorsBelowOneCountByTheirLogarithm) {
  const Hypothesis weak(effectInfo("force_gain"), "muscle_0", plant_);
  const double usual_low = weak.info().parameters.front().usual_low;
  const auto excessAt = [&](double value) { return weak.excess(weak.coordinatesOf({{"gain", value}})); };
  EXPECT_EQ(excessAt(1.01 * usual_low), 0);
  EXPECT_NEAR(excessAt(usual_low), 0, 1e-9);
  EXPECT_NEAR(excessAt(std::pow(usual_low, std::numbers::e)), 1, 1e-9);
  EXPECT_GT(excessAt(1.0 / 9), excessAt(1 + 8.0 / 9)) << "odder than a difference of eight ninths";
  EXPECT_TRUE(std::isfinite(excessAt(0)));
}

/// In an explanation of two effects, each is judged by its own coordinates.
TEST_F(EvidenceOnARig, FindsTheCoordinatesOfEveryEffect) {
  const double per_z_kg = causes_.hypotheses[payload].valuesAt(Eigen::VectorXd::Constant(1, 1)).front().second;
  Explanation pair = fitted({threshold, payload}, 1);
  const double before = evidence_.price(pair);
  pair.z[2] = std::numbers::e / per_z_kg;
  EXPECT_NEAR(evidence_.price(pair) - before, prices.excess, 1e-9);
}

TEST_F(EvidenceOnARig, NumbersThatAreOffByTolerancesCostTheirSquares) {
  Explanation off = fitted({payload}, 2);
  off.numbers = Eigen::Vector2d(1, -2);
  EXPECT_NEAR(ofSingle(payload, 2) - evidence_.score(off), 0.5 * (1 + 4), 1e-9);
}

TEST_F(EvidenceOnARig, InactiveEffectsAndFailedFitsHaveNone) {
  Explanation inactive = fitted({payload}, 1);
  inactive.is_inactive = true;
  EXPECT_EQ(evidence_.score(inactive), -std::numeric_limits<double>::infinity());
  Explanation failed = fitted({payload}, 1);
  failed.residual = {};
  EXPECT_EQ(evidence_.score(failed), -std::numeric_limits<double>::infinity());
}

TEST(NamedSet, IsTheLikeliestOne) {
  EXPECT_EQ(namedSet({{"lag"}, {"lag", "gain"}}, {0.44, 0.56}), 1U);
  EXPECT_EQ(namedSet({{"lag", "backlash"}, {"gain", "threshold"}, {"gain", "threshold", "creep"}}, {0.4, 0.3, 0.3}), 0U)
      << "though each of its effects is likelier absent";
  EXPECT_EQ(namedSet({{"lag"}, {"delay"}, {"creep"}}, {0.3, 0.4, 0.3}), 1U);
}

TEST(NamedSet, HasTheFewestExpectedErrorsWhereSetsTie) {
  // Three sets agree on a lag and a delay, and two have a third effect each.
  EXPECT_EQ(namedSet({{"lag", "delay", "creep"}, {"lag", "delay", "offset"}, {"lag", "delay"}}, {0.36, 0.33, 0.31}), 2U);
  EXPECT_EQ(namedSet({{"lag"}, {"lag", "gain", "bias"}, {"lag", "gain"}}, {0.36, 0.33, 0.31}), 2U) << "a gain is likelier present";
  EXPECT_EQ(namedSet({{"lag", "gain"}, {"lag", "bias"}, {"lag", "leak"}}, {0.36, 0.33, 0.31}), 0U);
}

TEST_F(EvidenceOnARig, SomethingElseIsLikelyWhereTheExplanationsLeaveMuch) {
  const auto somethingElse = [&](double sigmas, double other_sigmas, double probability_of_other) {
    std::vector<Explanation> explanations = {fitted({gain}, other_sigmas), fitted({payload}, sigmas)};
    explanations[0].probability = probability_of_other;
    explanations[1].probability = 1 - probability_of_other;
    return evidence_.ofSomethingElse(explanations);
  };
  const auto beside = [&](double sigmas) {
    const double share = temperedMisfit(sigmas, gap) / temperedMisfit(gap, gap);
    return 1 / (1 + std::exp(-per_share_left * (share - share_of_unknown)));
  };
  for (const double sigmas : {1.0, 2.5, 5.0, 15.0}) {
    EXPECT_NEAR(somethingElse(sigmas, 16, 0), beside(sigmas), 1e-9) << sigmas;
    EXPECT_NEAR(somethingElse(sigmas, 16, 0.25), 0.75 * beside(sigmas) + 0.25 * beside(16), 1e-9) << sigmas;
  }
  EXPECT_GT(somethingElse(15, 16, 0), 0.88);
  EXPECT_LT(somethingElse(1.2, 16, 0), 0.12);
  EXPECT_NEAR(somethingElse(0.5, 16, 0), somethingElse(1, 16, 0), 1e-9) << "less than noise is no less";
}

}  // namespace
}  // namespace musclesim
