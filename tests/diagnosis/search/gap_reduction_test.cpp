// The gap reduction and the interval in which that of another recording is expected.
#include "diagnosis/search/gap_reduction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../planted.h"

namespace musclesim {
namespace {

TEST(ClearlyBeats, AsksForFivePointsOrHalfOfWhatIsLeft) {
  EXPECT_TRUE(clearlyBeats(26, 20));
  EXPECT_FALSE(clearlyBeats(24, 20));
  EXPECT_TRUE(clearlyBeats(98.6, 97)) << "leaves less than half of what the control leaves";
  EXPECT_FALSE(clearlyBeats(98.4, 97));
}

TEST(ClearlyBeats, RefusesWhatGainsNothingHoweverBadTheControlIs) {
  EXPECT_FALSE(clearlyBeats(-10, -80));
  EXPECT_FALSE(clearlyBeats(4, -80));
  EXPECT_TRUE(clearlyBeats(6, -80));
}

/// Residuals that are constant on each recording: 10 sigmas without effects, `left` sigmas with them.
class ThreeRigs : public testing::Test {
 protected:
  Estimate intervalOf(double left_on_held_out, double left_on_first, double left_on_second) const {
    const double sigma = planted::noise_mm;
    const Eigen::VectorXd before = Eigen::VectorXd::Constant(rows_, 10 * sigma),
                          both_before = Eigen::VectorXd::Constant(2 * rows_, 10 * sigma);
    const Eigen::VectorXd after = Eigen::VectorXd::Constant(rows_, left_on_held_out * sigma);
    Eigen::VectorXd both_after(2 * rows_);
    both_after << Eigen::VectorXd::Constant(rows_, left_on_first * sigma), Eigen::VectorXd::Constant(rows_, left_on_second * sigma);
    return gapReductionInterval({held_out_, before, after}, {fitted_, both_before, both_after}, 1);
  }

  static constexpr int rows_ = 150;
  DiagnosisOptions options_;
  Plant plant_{{planted::recorded({}, 0.1, 1), planted::recorded({}, 0.12, 2), planted::recorded({}, 0.14, 3)}, options_};
  Comparison fitted_{plant_, {{0, 0, rows_}, {1, 0, rows_}}}, held_out_{plant_, {{2, 0, rows_}}};
};

TEST_F(ThreeRigs, ShrinkIsThatOnWhatWasHeldOut) {
  EXPECT_NEAR(intervalOf(2, 2, 2).value, 100 * (1 - 3.0 / 99), 1e-9);
}

TEST_F(ThreeRigs, IntervalIsAPointWhereAllRecordingsAgree) {
  const Estimate reduction = intervalOf(2, 2, 2);
  EXPECT_NEAR(reduction.low, reduction.value, 1e-9);
  EXPECT_NEAR(reduction.high, reduction.value, 1e-9);
}

TEST_F(ThreeRigs, IntervalReachesAllWhereNoiseAloneMayLeaveTheRest) {
  const Estimate reduction = intervalOf(1.02, 1.02, 1.02);  // a gap of 0.04 is left of 99
  EXPECT_LT(reduction.value, 100);
  EXPECT_EQ(reduction.high, 100);
  EXPECT_LT(intervalOf(1.1, 1.1, 1.1).high, 100);
}

TEST_F(ThreeRigs, IntervalIsStudentsForOneMoreRecording) {
  // Normalised gaps after: 3, 8, 15 of 99 before.
  const Estimate reduction = intervalOf(2, 3, 4);
  const double logs[] = {std::log(3.0 / 99), std::log(8.0 / 99), std::log(15.0 / 99)};
  const double mean = (logs[0] + logs[1] + logs[2]) / 3;
  double squares = 0;
  for (const double y : logs) squares += (y - mean) * (y - mean);
  const double reach = 4.303 * std::sqrt(squares / 2) * std::sqrt(1 + 1.0 / 3);  // t, 97.5 %, 2 degrees of freedom
  EXPECT_NEAR(reduction.low, 100 * (1 - std::exp(mean + reach)), 1e-6);
  EXPECT_NEAR(reduction.high, 100 * (1 - std::exp(mean - reach)), 1e-6);
}

TEST_F(ThreeRigs, NoiseAloneIsNoEvidenceOfMore) {
  const Estimate reduction = intervalOf(1, 0.5, 1.02);  // all below what noise alone may leave
  EXPECT_NEAR(reduction.value, 100, 1e-9);
  EXPECT_NEAR(reduction.low, 100 * (1 - 0.07 / 99), 1e-9);
}

}  // namespace
}  // namespace musclesim
