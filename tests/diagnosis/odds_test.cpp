// The odds of fitted hypotheses.
#include "diagnosis/odds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "planted.h"

namespace musclesim {
namespace {

/// Residuals are constant: the model without effects leaves 20 sigmas.
class OddsOnARig : public testing::Test {
 protected:
  enum Index : std::size_t { payload, bias, gain, threshold };

  Eigen::VectorXd leaving(double sigmas) const { return Eigen::VectorXd::Constant(comparison_.size(), sigmas * planted::noise_mm); }

  FittedHypothesis fitted(const std::vector<std::size_t>& members, double sigmas) const {
    FittedHypothesis result{members, {}, {}, leaving(sigmas), 0, 0};
    Eigen::Index count = 0;
    for (const std::size_t member : members) count += hypotheses_[member].coordinateCount();
    result.z = Eigen::VectorXd::Constant(count, 0.1);
    return result;
  }

  double ofSingle(std::size_t member, double sigmas) const { return odds_.ofHypothesis(fitted({member}, sigmas)); }

  DiagnosisOptions options_;
  Plant plant_{planted::plant({}), options_};
  Comparison comparison_{plant_, {{0, 0, 400}}};
  std::vector<Hypothesis> hypotheses_ = {{effectInfo("payload"), "hand", plant_},
                                         {effectInfo("sensor_bias"), "signal_length_0", plant_},
                                         {effectInfo("force_gain"), "muscle_0", plant_},
                                         {effectInfo("threshold_pressure"), "muscle_0", plant_}};
  Eigen::VectorXd nominal_ = leaving(20);
  Odds odds_{comparison_, nominal_, hypotheses_};
  Weighing weighing_;
};

TEST_F(OddsOnARig, FollowWhatIsLeft) {
  const double per_misfit = weighing_.per_misfit + weighing_.per_closer_misfit;
  EXPECT_NEAR(ofSingle(payload, 5) - ofSingle(payload, 10), per_misfit * std::log(2), 1e-9);
  EXPECT_NEAR(ofSingle(payload, 0.5), ofSingle(payload, 0.9), 1e-9) << "below the floor all are as good";
  EXPECT_NEAR(ofSingle(payload, 1.1) - ofSingle(payload, 2.2), weighing_.per_closer_misfit * std::log(2), 1e-9)
      << "below a tenth of the gap nearly";
}

TEST_F(OddsOnARig, CountParameters) {
  ASSERT_EQ(hypotheses_[threshold].coordinateCount(), hypotheses_[gain].coordinateCount() + 1);
  EXPECT_NEAR(ofSingle(gain, 2) - ofSingle(threshold, 2), weighing_.per_parameter, 1e-9);
}

TEST_F(OddsOnARig, NoneOfTheseBeatsWhatHardlyExplainsAndLosesToWhatDoes) {
  auto against = [&](double sigmas) {
    return odds_.ofNoneOfThese({fitted({payload}, sigmas), fitted({gain}, 16)}) - ofSingle(payload, sigmas);
  };
  EXPECT_GT(against(15), 2);
  EXPECT_LT(against(2.5), -2);
  EXPECT_NEAR(against(1), -weighing_.per_share_left * weighing_.share_of_unknown, 1e-9) << "what looks like the cause may be another";
  EXPECT_GT(odds_.ofNoneOfThese({}), odds_.ofNoEffect());
}

TEST_F(OddsOnARig, NoneOfTheseIsLikelierBesideALawOfManyStrengths) {
  const std::vector<Hypothesis> laws = {{effectInfo("pressure_calibration"), "muscle_0", plant_},
                                        {effectInfo("force_gain"), "muscle_0", plant_}};
  ASSERT_EQ(laws[0].strengths().size(), 2u);
  ASSERT_EQ(laws[1].strengths().size(), 1u);
  const Odds odds(comparison_, nominal_, laws);
  auto against = [&](std::size_t member) {
    FittedHypothesis alone{{member}, Eigen::VectorXd::Constant(laws[member].coordinateCount(), 0.1), {}, leaving(3), 0, 0};
    return odds.ofNoneOfThese({alone}) - odds.ofHypothesis(alone);
  };
  EXPECT_NEAR(against(0) - against(1), weighing_.per_further_strength, 1e-9);
}

TEST_F(OddsOnARig, AreOfWhatWasNotSeenWhereThatIsKnown) {
  FittedHypothesis flexible = fitted({payload}, 1);
  flexible.cross_validated = leaving(4);
  EXPECT_NEAR(odds_.ofHypothesis(flexible), ofSingle(payload, 4), 1e-9);
}

TEST_F(OddsOnARig, AFurtherEffectThatGainsNothingCosts) {
  const FittedHypothesis alone = fitted({payload}, 2), pair = fitted({payload, bias}, 2);
  EXPECT_NEAR(odds_.ofHypothesis(alone) - odds_.ofHypothesis(pair), weighing_.per_effect + weighing_.per_parameter, 1e-9);
}

TEST_F(OddsOnARig, AFurtherEffectInTheSamePlaceCostsMore) {
  const double same = odds_.ofHypothesis(fitted({gain, threshold}, 1)), elsewhere = odds_.ofHypothesis(fitted({gain, bias}, 1));
  EXPECT_NEAR(elsewhere - same, weighing_.per_same_place + weighing_.per_parameter, 1e-9);
}

TEST_F(OddsOnARig, PlacesOverlapThroughAllAndThroughPairsOfMuscles) {
  const std::vector<Hypothesis> on_two = {{effectInfo("force_gain"), "muscle_1", plant_},
                                          {effectInfo("leak"), "all", plant_},
                                          {effectInfo("channel_swap"), "muscle_0+muscle_1", plant_},
                                          {effectInfo("leak"), "muscle_10", plant_},
                                          {effectInfo("payload"), "hand", plant_},
                                          {effectInfo("base_tilt"), "base", plant_},
                                          {effectInfo("sensor_bias"), "all", plant_}};
  const Odds odds(comparison_, nominal_, on_two);
  auto costs = [&](std::size_t one, std::size_t other) {
    auto of = [&](const std::vector<std::size_t>& members) {
      FittedHypothesis result{members, {}, {}, leaving(1), 0, 0};
      Eigen::Index count = 0;
      for (const std::size_t member : members) count += on_two[member].coordinateCount();
      result.z = Eigen::VectorXd::Zero(count);
      return result;
    };
    const double parameters = static_cast<double>(on_two[other].coordinateCount()) * weighing_.per_parameter;
    const double shared = other == 6 ? weighing_.shared_sensor : 0;
    return odds.ofHypothesis(of({one})) - odds.ofHypothesis(of({one, other})) - parameters - shared - weighing_.per_effect;
  };
  EXPECT_NEAR(costs(0, 1), weighing_.per_same_place, 1e-9) << "a muscle and all";
  EXPECT_NEAR(costs(0, 2), weighing_.per_same_place, 1e-9) << "a muscle and a pair with it";
  EXPECT_NEAR(costs(4, 5), weighing_.per_same_place, 1e-9) << "both on the body";
  EXPECT_NEAR(costs(0, 3), 0, 1e-9) << "another muscle";
  EXPECT_NEAR(costs(0, 4), 0, 1e-9) << "the body";
  EXPECT_NEAR(costs(1, 6), 0, 1e-9) << "all sensors are no muscle";
}

TEST_F(OddsOnARig, HopeIsWhatAPerfectFurtherEffectWouldGain) {
  EXPECT_GT(odds_.optimisticBound(fitted({gain}, 4)), 0);
  EXPECT_NEAR(odds_.optimisticBound(fitted({gain}, 1)), -weighing_.per_effect - weighing_.per_parameter, 1e-9);
}

}  // namespace
}  // namespace musclesim
