// Coordinates of hypotheses, and coarse simulations in place of fine ones.
#include "diagnosis/fit/hypothesis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../planted.h"
#include "diagnosis/fit/comparison.h"

namespace musclesim {
namespace {

class PlantedRig : public testing::Test {
 protected:
  Hypothesis hypothesis(const std::string& id, const std::string& component) const { return {effectInfo(id), component, plant_}; }

  DiagnosisOptions options_;
  Plant plant_{planted::plant({}), options_};
};

TEST_F(PlantedRig, ExcessIsTheLogarithmOfTheDistanceBeyondTheUsualRange) {
  const Hypothesis payload = hypothesis("payload", "hand");
  Eigen::VectorXd z = payload.typical();
  EXPECT_EQ(payload.excess(z), 0);
  const double typical_kg = payload.valuesAt(z).front().second, usual_kg = effectInfo("payload").parameters.front().usual_high;
  z[0] = std::exp(0.7) * usual_kg / typical_kg;
  EXPECT_NEAR(payload.excess(z), 0.7, 1e-9);

  const Hypothesis limit = hypothesis("flow_limit", "muscle_0");
  z = limit.typical();
  EXPECT_EQ(limit.excess(z), 0);
  z[0] = limit.typical()[0] * std::exp(3);  // slower: the rate is the typical one over z
  EXPECT_GT(limit.excess(z), 1);
  z[0] = 1e-3;  // nearly unlimited
  EXPECT_EQ(limit.excess(z), 0);
}

/// The bound is twenty-five times the usual value, whatever screening made of the typical value.
TEST_F(PlantedRig, BoundsAreThoseOfTheUsualRange) {
  for (const double share : {1.0, 0.01}) {
    Hypothesis leak = hypothesis("leak", "muscle_0"), spring = hypothesis("series_elasticity", "muscle_0");
    const double usual_per_s = effectInfo("leak").parameters.front().usual_high,
                 soft = effectInfo("series_elasticity").parameters.front().usual_low;
    leak.rescale(leak.strengths().front(), share);
    spring.rescale(spring.strengths().front(), share);
    const Eigen::VectorXd far = Eigen::VectorXd::Constant(leak.coordinateCount(), 1e9);
    EXPECT_NEAR(leak.valuesAt(leak.clamped(far)).front().second, 25 * usual_per_s, 1e-9);
    EXPECT_NEAR(spring.valuesAt(spring.clamped(Eigen::VectorXd::Constant(spring.coordinateCount(), 1e9))).front().second, soft / 25, 1e-9);
  }
}

/// An elbow has one joint and two muscles; the lengths of both are measured.
TEST(Hypotheses, APlaceIsAComponentAndAPartOfTheMachine) {
  Recording recording = planted::plant({}).front();
  recording.info = {};
  recording.info.robot = "elbow";
  const std::vector<double> command = recording.signals[0].values, length = recording.signals[1].values;
  recording.signals = {{"command_0", command}, {"command_1", command}, {"length_0_mm", length}, {"length_1_mm", length}};
  const DiagnosisOptions options;
  const Plant elbow({recording}, options);
  std::map<std::string, std::string> place;
  for (const Hypothesis& hypothesis : hypotheses(elbow, options)) place[hypothesis.label()] = hypothesis.place();
  const std::string of_lag = place.at("valve_lag@muscle_0");
  EXPECT_EQ(place.at("transport_delay@muscle_0"), of_lag);
  EXPECT_EQ(place.at("flow_limit@muscle_0"), of_lag);
  EXPECT_NE(place.at("valve_lag@all"), of_lag);
  EXPECT_NE(place.at("force_gain@muscle_0"), of_lag);
  EXPECT_EQ(place.at("attachment_offset@muscle_0"), place.at("length_offset@muscle_0"));
  EXPECT_EQ(place.at("joint_coulomb_friction@joint_elbow"), place.at("braid_hysteresis@all")) << "the only joint";
  EXPECT_NE(place.at("sensor_gain@signal_length_0"), place.at("sensor_gain@signal_length_1"));
}

/// The variants of a lag are one with a second lag and one without.
TEST_F(PlantedRig, AnEffectIsNearestToTheVariantThatCanBeIt) {
  const ActiveEffect plain{"valve_lag", "muscle_0", {{"fill_time_constant_s", 0.06}, {"vent_time_constant_s", 0.09}}};
  ActiveEffect twice = plain;
  twice.parameters["next_lag_ratio"] = 0.4;
  const std::vector<Hypothesis> lags = hypothesis("valve_lag", "muscle_0").variants(plant_);
  EXPECT_EQ(lags[0].nearestTo(twice).second, 0);
  EXPECT_EQ(lags[1].nearestTo(twice).second, 1) << "the second lag";
  const auto [z, others] = lags[1].nearestTo(plain);
  EXPECT_EQ(others, 0);
  EXPECT_NEAR(std::get<double>(lags[1].at(z).parameters.at("vent_time_constant_s")), 0.09, 1e-9);
}

TEST_F(PlantedRig, ALawWithAShareOfSomethingHasAVariantWithout) {
  const std::vector<Hypothesis> lags = hypothesis("valve_lag", "muscle_0").variants(plant_);
  ASSERT_EQ(lags.size(), 2);
  EXPECT_EQ(lags[0].coordinateCount(), 3);
  EXPECT_EQ(lags[1].coordinateCount(), 2);
  EXPECT_EQ(lags[0].label(), lags[1].label());
  EXPECT_EQ(lags[1].strengths(), (std::vector<int>{0, 1}));
  const ActiveEffect simple = lags[1].at(lags[1].typical());
  EXPECT_EQ(std::get<double>(simple.parameters.at("next_lag_ratio")), 0);
  EXPECT_EQ(hypothesis("payload", "hand").variants(plant_).size(), 1);
}

/// On a rig, friction of the muscle's braid that is always the same is friction of its only load.
TEST_F(PlantedRig, ConstantFrictionOfMusclesIsTriedWhereSeveralJointsMove) {
  const auto strengths = [](const Plant& plant) {
    std::vector<std::string> names;
    for (const Hypothesis& friction : Hypothesis(effectInfo("braid_hysteresis"), "muscle_0", plant).variants(plant))
      for (const std::string& name : friction.strengthNames()) names.push_back(name);
    return names;
  };
  EXPECT_EQ(strengths(plant_), (std::vector<std::string>{"relative_width", "relative_width"}));
  std::vector<Recording> of_two_joints;
  for (const char* file : {"one.csv", "two.csv"}) {
    Recording plan;
    plan.file = file;
    plan.info.robot = "pulley_arm";
    for (int row = 0; row < 30; ++row) plan.time_s.push_back(0.01 * row);
    for (int muscle = 0; muscle < 6; ++muscle)
      plan.signals.push_back({"command_" + std::to_string(muscle), std::vector<double>(30, *file == 'o' ? 0.4 : 0.3)});
    of_two_joints.push_back(replayRecording(plan, {}).simulated);
    of_two_joints.back().file = file;
  }
  EXPECT_EQ(strengths(Plant(of_two_joints, options_)),
            (std::vector<std::string>{"relative_width", "relative_width", "constant_friction_N"}));
}

TEST_F(PlantedRig, HeldSamplesAreCountedNotFitted) {
  std::vector<Recording> recordings = planted::plant({});
  for (Recording& recording : recordings) {
    std::vector<double>& y = recording.signals[1].values;
    for (std::size_t row = 0; row < y.size(); ++row) y[row] = y[row - row % 5];  // four of five
  }
  const Plant plant(recordings, options_);
  const Hypothesis dropout(effectInfo("sensor_dropout"), "signal_length_0", plant);
  EXPECT_EQ(dropout.coordinateCount(), 0);
  std::map<std::string, double> values;
  for (const auto& [name, value] : dropout.valuesAt({})) values[name] = value;
  EXPECT_NEAR(values.at("fraction"), 0.8, 0.01);
  EXPECT_NEAR(values.at("mean_gap_samples"), 4, 0.05);
}

TEST_F(PlantedRig, WhatHasNoUsualRangeHasNoExcess) {
  const Hypothesis bias = hypothesis("sensor_bias", "signal_length_0");
  EXPECT_EQ(bias.excess(Eigen::VectorXd::Constant(bias.coordinateCount(), 40)), 0);
}

/// A dead time of the commands in the place of one of all sensors begins with the same delay.
TEST_F(PlantedRig, StrengthsOfTheSameNamesTakeEachOthersValues) {
  const Hypothesis late = hypothesis("transport_delay", "muscle_0"), read_late = hypothesis("sensor_delay", "all");
  EXPECT_EQ(late.strengthNames(), std::vector<std::string>{"delay_s"});
  EXPECT_EQ(read_late.strengthNames(), late.strengthNames()) << "a share of a filter is no strength";
  EXPECT_NE(hypothesis("valve_lag", "muscle_0").strengthNames(), late.strengthNames());
  const Eigen::VectorXd z = Eigen::VectorXd::Constant(late.coordinateCount(), 1.7);
  const Eigen::VectorXd own = read_late.coordinatesOf(late.at(z).parameters);
  EXPECT_NEAR(read_late.valuesAt(own).front().second, late.valuesAt(z).front().second, 1e-12);
}

TEST_F(PlantedRig, WeakenedStrengthsAreAShareOfWhatTheyWere) {
  Hypothesis payload = hypothesis("payload", "hand"), limit = hypothesis("flow_limit", "muscle_0");
  const double typical_kg = payload.valuesAt(payload.typical()).front().second;
  payload.rescale(0, 0.1);
  EXPECT_NEAR(payload.valuesAt(payload.typical()).front().second, 0.1 * typical_kg, 1e-12);
  const double typical_per_s = limit.valuesAt(limit.typical()).front().second;
  limit.rescale(limit.strengths().front(), 0.1);
  EXPECT_NEAR(limit.valuesAt(limit.typical()).front().second, 10 * typical_per_s, 1e-9) << "a weaker limit lets more through";
}

TEST_F(PlantedRig, AnotherForceLawBeginsAtTheLawOfTheModel) {
  const Hypothesis law = hypothesis("force_law", "muscle_0");
  ASSERT_EQ(law.strengths().size(), 4u);
  const Eigen::VectorXd neutral = Eigen::VectorXd::Zero(law.coordinateCount());
  EXPECT_EQ(law.clamped(neutral), neutral);
  Comparison comparison(plant_, plant_.split().fit);
  EXPECT_EQ(comparison.predicted(Model{{law.at(neutral)}, {}}), comparison.predicted(Model{}));
}

TEST_F(PlantedRig, BitsAreRoundedAndTruncated) {
  const std::vector<Hypothesis> variants = hypothesis("command_quantisation", "muscle_0").variants(plant_);
  EXPECT_EQ(variants.size(), 32U);
  for (const Hypothesis& variant : variants) EXPECT_EQ(variant.coordinateCount(), 0);
  EXPECT_NE(variants[0].at({}), variants[1].at({}));
}

TEST_F(PlantedRig, ALeakIsLookedAtAsASmallAndAsALargeOne) {
  const std::vector<Hypothesis> leaks = hypothesis("leak", "muscle_0").variants(plant_);
  ASSERT_EQ(leaks.size(), 2U);
  auto perSecond = [](const Hypothesis& leak) {
    for (const auto& [name, value] : leak.valuesAt(leak.typical()))
      if (name == "leak_per_s") return value;
    return 0.0;
  };
  EXPECT_LT(perSecond(leaks[0]), 0.05);
  EXPECT_NEAR(perSecond(leaks[1]), 0.5, 1e-9);
}

/// Stops that are not reached show neither where they are nor how they give way, so each variant has only one strength.
TEST_F(PlantedRig, StopsAreHardOrGiveWay) {
  const std::vector<Hypothesis> stops = hypothesis("joint_stop_offset", "joint_x").variants(plant_);
  ASSERT_EQ(stops.size(), 2U);
  for (const Hypothesis& variant : stops) EXPECT_EQ(variant.strengthNames(), std::vector<std::string>{"offset_deg"});
  const auto typicalGiveDeg = [](const Hypothesis& variant) {
    return std::get<double>(variant.at(variant.typical()).parameters.at("give_deg"));
  };
  EXPECT_EQ(typicalGiveDeg(stops[0]), 0);
  EXPECT_NEAR(typicalGiveDeg(stops[1]), std::sqrt(0.2 * 15), 1e-9) << "the geometric mean of the usual range";
  EXPECT_NEAR(stops[1].excess(stops[1].coordinatesOf({{"offset_deg", 15.0}, {"give_deg", 30.0}})), std::log(2), 1e-9);
}

TEST_F(PlantedRig, WhatIsLeftOutStaysNeutral) {
  Hypothesis force = hypothesis("external_force", "hand");
  const auto all = force.valuesAt(force.typical());
  ASSERT_EQ(all.size(), 3U);
  force.leaveOut(1);
  EXPECT_EQ(force.strengths(), (std::vector<int>{0, 1}));
  const auto values = force.valuesAt(force.typical());
  ASSERT_EQ(values.size(), 2U);
  EXPECT_EQ(values[0], all[0]);
  EXPECT_EQ(values[1], all[2]);
  EXPECT_EQ(std::get<double>(force.at(force.typical()).parameters.at(all[1].first)), 0);
}

/// Coarse predictions are exact without effects, and close to fine ones with them.
TEST_F(PlantedRig, CoarseStepsAreCorrected) {
  Comparison comparison(plant_, plant_.split().fit);
  const Model payload{{{"payload", "hand", {{"mass_kg", 0.3}}}}, {}};
  const Eigen::VectorXd fine = comparison.predicted(Model{}), with = comparison.predicted(payload);
  const Eigen::VectorXd uncorrected = comparison.predicted(payload, Fidelity::coarse);
  comparison.goCoarse(fine);
  EXPECT_EQ(comparison.fidelity(), Fidelity::coarse);
  EXPECT_LT((comparison.predicted(Model{}) - fine).cwiseAbs().maxCoeff(), 1e-12);
  auto rms = [](const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / static_cast<double>(v.size())); };
  EXPECT_GT(rms(uncorrected - with), 0) << "coarse steps are not coarse";
  const double error = rms(comparison.predicted(payload) - with);
  EXPECT_LT(error, 0.7 * rms(uncorrected - with));
  EXPECT_LT(error, 0.02 * rms(with - fine)) << "of the payload's own change";
}

/// A tolerance between the errors of coarse and of medium steps.
TEST_F(PlantedRig, MediumStepsAreTakenWhereOnlyTheyFollow) {
  Comparison comparison(plant_, plant_.split().fit);
  const Eigen::VectorXd coarse = comparison.predicted(Model{}, Fidelity::coarse), medium = comparison.predicted(Model{}, Fidelity::medium);
  double largest_sigmas = 0;
  for (const Comparison::Block& block : comparison.blocks())
    largest_sigmas = std::max(largest_sigmas, std::sqrt(comparison.meanSquare(block, medium - coarse)) / block.sigma);
  ASSERT_GT(largest_sigmas, 0);
  const double bearable_sigmas = 5;
  comparison.goCoarse(medium + (bearable_sigmas / largest_sigmas - 0.5) * (medium - coarse));
  EXPECT_EQ(comparison.fidelity(), Fidelity::medium);
}

/// Only screening uses the coarsest steps, if they follow the motion.
TEST_F(PlantedRig, ALookBeginsWithTheCoarsestSteps) {
  Comparison screening(plant_, plant_.split().fit), fit = screening;
  const Eigen::VectorXd coarse = screening.predicted(Model{}, Fidelity::coarse),
                        coarsest = screening.predicted(Model{}, Fidelity::coarsest);
  EXPECT_NE(coarse, coarsest);
  screening.goCoarse(coarsest, Comparison::Purpose::screening);
  EXPECT_EQ(screening.fidelity(), Fidelity::coarsest);
  fit.goCoarse(coarsest);
  EXPECT_NE(fit.fidelity(), Fidelity::coarsest);
}

/// The gap is three millimetres or sixty sigmas; a tenth of it is six sigmas.
TEST_F(PlantedRig, ALookBearsMoreBesideALargeGap) {
  std::vector<Recording> recordings = planted::plant({});
  for (Recording& recording : recordings)
    for (double& value : recording.signals[1].values) value += 60 * planted::noise_mm;
  const Plant far(recordings, options_);
  Comparison beside(far, far.split().fit), without(plant_, plant_.split().fit);
  const double shift_mm = 5.5 * planted::noise_mm;
  for (Comparison* comparison : {&beside, &without})
    comparison->goCoarse(comparison->predicted(Model{}, Fidelity::coarsest).array() - shift_mm, Comparison::Purpose::screening);
  EXPECT_EQ(beside.fidelity(), Fidelity::coarsest);
  EXPECT_EQ(without.fidelity(), Fidelity::medium);
  EXPECT_FALSE(without.unsteady().signal.empty());
}

/// Where even medium steps lead elsewhere, what they change is noise, so that they serve.
TEST_F(PlantedRig, CoarseStepsThatLeadElsewhereAreNotTaken) {
  Comparison comparison(plant_, plant_.split().fit);
  const Eigen::VectorXd elsewhere = comparison.predicted(Model{}).array() + 10 * planted::noise_mm;
  comparison.goCoarse(elsewhere);
  EXPECT_EQ(comparison.fidelity(), Fidelity::medium);
  EXPECT_LT((comparison.predicted(Model{}) - elsewhere).cwiseAbs().maxCoeff(), 1e-9) << "corrected by what they change";
}

}  // namespace
}  // namespace musclesim
