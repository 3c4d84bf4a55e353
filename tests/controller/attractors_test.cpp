#include "musclesim/controller/attractors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// Attractors (0.6, 0), (0, 0.8), (-0.5, -0.5) of width 0.5.
AttractorMixture triangle() {
  Eigen::MatrixXd attractors(2, 3);
  attractors << 0.6, 0.0, -0.5, 0.0, 0.8, -0.5;
  return {attractors, 0.5};
}

TEST(AttractorMixture, MatchesEquation6WorkedOutByHand) {
  // x = (0.2, 0.1): squared distances 0.17, 0.53, 0.85; g = exp(-2 * those) = 0.711770, 0.346456, 0.182684, sum 1.240910
  // N = 0.573588, 0.279195, 0.147217
  // f = (0.6 N1 - 0.5 N3 - 0.2, 0.8 N2 - 0.5 N3 - 0.1) = (0.0705438, 0.0497473)
  const Eigen::Vector2d x(0.2, 0.1);
  const Eigen::VectorXd N = triangle().weights(x);
  EXPECT_NEAR(N[0], 0.5735875441568984, 1e-14);
  EXPECT_NEAR(N[1], 0.2791950311089101, 1e-14);
  EXPECT_NEAR(N[2], 0.1472174247341916, 1e-14);
  const Eigen::VectorXd f = triangle().drift(x);
  EXPECT_NEAR(f[0], 0.07054381412704325, 1e-14);
  EXPECT_NEAR(f[1], 0.04974731252003226, 1e-14);
}

TEST(AttractorMixture, VanishesHalfwayBetweenTwoAttractors) {
  Eigen::MatrixXd attractors(1, 2);
  attractors << -0.5, 0.5;
  const AttractorMixture pair(attractors, 0.5);
  EXPECT_DOUBLE_EQ(pair.drift(Eigen::VectorXd::Zero(1))[0], 0.0);
  // x = 0.25: N2 = 1 / (1 + exp(-2 * (0.5625 - 0.0625))) = 1 / (1 + 1/e) = 0.7310586, f = 0.5 (2 N2 - 1) - 0.25
  EXPECT_NEAR(pair.drift(Eigen::VectorXd::Constant(1, 0.25))[0], 0.5 * (2 / (1 + std::exp(-1.0)) - 1) - 0.25, 1e-15);
}

TEST(AttractorMixture, NeverUnderflowsHoweverNarrow) {
  // Width 1/501 in ten dimensions: exp(-|xi - x|^2 / (2 width^2)) is far below the smallest double everywhere but at the attractors.
  RandomStream stream(3, "test");
  const auto mixture = AttractorMixture::random(10, 500, 1.0 / 501, 1, stream);
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(10, [&] { return stream.uniform(-1, 1); });
    const Eigen::VectorXd N = mixture.weights(x);
    ASSERT_TRUE(N.allFinite());
    ASSERT_NEAR(N.sum(), 1, 1e-12);
    ASSERT_GE(N.minCoeff(), 0);
    Eigen::Index nearest = 0, heaviest = 0;
    (mixture.attractors().colwise() - x).colwise().norm().minCoeff(&nearest);
    N.maxCoeff(&heaviest);
    ASSERT_EQ(nearest, heaviest);
  }
}

TEST(AttractorMixture, RandomEntriesFollowTheExponent) {
  // |u|^q below s has probability s^(1/q): s = 0.5 gives 1/2 for q = 1 and 1/16 for q = 1/4.
  for (const auto& [exponent, share] : {std::pair(1.0, 0.5), std::pair(0.25, 0.0625)}) {
    RandomStream stream(7, "test");
    const auto mixture = AttractorMixture::random(10, 2000, 0.25, exponent, stream);
    EXPECT_LE(mixture.attractors().cwiseAbs().maxCoeff(), 1);
    const double inner = static_cast<double>((mixture.attractors().array().abs() < 0.5).count()) / 20000;
    EXPECT_NEAR(inner, share, 0.015);
    EXPECT_NEAR(mixture.attractors().mean(), 0, 0.03);
  }
}

TEST(AttractorMixture, RejectsWhatItCannotBlend) {
  EXPECT_THROW(AttractorMixture(Eigen::MatrixXd(2, 0), 1), BadParameter);
  EXPECT_THROW(AttractorMixture(Eigen::MatrixXd::Zero(2, 3), 0), BadParameter);
  EXPECT_THROW(AttractorMixture(Eigen::MatrixXd::Zero(2, 3), std::nan("")), BadParameter);
  auto mixture = triangle();
  EXPECT_THROW(mixture.replace(Eigen::MatrixXd::Zero(2, 4)), BadParameter);
}

TEST(Fluctuated, MatchesEquation5WorkedOutByHand) {
  // Without noise, step alpha = 0.5: x + 0.5 f = (0.2 + 0.0352719, 0.1 + 0.0248737)
  RandomStream noise(1, "test");
  const Eigen::VectorXd x = Eigen::Vector2d(0.2, 0.1);
  const Eigen::VectorXd next = fluctuated(x, triangle(), 0.5, 0, noise);
  EXPECT_NEAR(next[0], 0.2352719070635216, 1e-14);
  EXPECT_NEAR(next[1], 0.1248736562600161, 1e-14);
}

TEST(Fluctuated, AddsOneNormalNumberPerEntryAndClips) {
  RandomStream noise(1, "test"), same(1, "test");
  const Eigen::VectorXd x = Eigen::Vector2d(0.2, 0.1);
  const double first = same.normal(), second = same.normal();
  const Eigen::VectorXd next = fluctuated(x, triangle(), 0, 0.05, noise);
  EXPECT_DOUBLE_EQ(next[0], 0.2 + 0.05 * first);
  EXPECT_DOUBLE_EQ(next[1], 0.1 + 0.05 * second);
  for (int i = 0; i < 100; ++i) EXPECT_LE(fluctuated(x, triangle(), 0, 100, noise).cwiseAbs().maxCoeff(), 1);
}

TEST(Fluctuated, LimitsThePullToTheMeanOfTheAttractorsAndIgnoresNegativeActivity) {
  RandomStream noise(1, "test");
  const Eigen::VectorXd x = Eigen::Vector2d(0.2, 0.1);
  const Eigen::VectorXd there = x + triangle().drift(x);
  EXPECT_TRUE(fluctuated(x, triangle(), 1, 0, noise).isApprox(there, 1e-14));
  EXPECT_TRUE(fluctuated(x, triangle(), 1e6, 0, noise).isApprox(there, 1e-14));
  EXPECT_EQ(fluctuated(x, triangle(), -3, 0, noise), x);
}

TEST(Pressures, AreAHyperbolicTangentOfTheState) {
  Eigen::VectorXd x(5);
  x << -1, -0.5, 0, 0.5, 1;
  const Action p = pressures(x);
  const double expected[] = {0.002472623156634768, 0.0474258731775668, 0.5, 0.9525741268224333, 0.9975273768433652};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(p[i], expected[i], 1e-15);
}

TEST(DiscountedMean, MatchesEquation9WorkedOutByHand) {
  // gamma = 0.5, values 100, 60, 80:  A = 50, 55, 67.5;  B = 0.5, 0.75, 0.875
  DiscountedMean mean(0.5);
  EXPECT_EQ(mean.meanOr(42), 42);
  mean.add(100);
  EXPECT_DOUBLE_EQ(mean.meanOr(42), 100);
  mean.add(60);
  EXPECT_DOUBLE_EQ(mean.meanOr(42), 55 / 0.75);
  mean.add(80);
  EXPECT_DOUBLE_EQ(mean.meanOr(42), 67.5 / 0.875);
}

TEST(DiscountedMean, EqualsTheSumItIsARecursionOf) {
  const double gamma = 0.9;
  RandomStream stream(1, "test");
  DiscountedMean mean(gamma);
  std::vector<double> past;
  for (int t = 0; t < 50; ++t) {
    past.push_back(stream.uniform(0, 300));
    mean.add(past.back());
    double weighted = 0, weights = 0;
    for (std::size_t k = 1; k <= past.size(); ++k) {
      weighted += std::pow(gamma, static_cast<double>(k)) * past[past.size() - k];
      weights += std::pow(gamma, static_cast<double>(k));
    }
    ASSERT_NEAR(mean.meanOr(0), weighted / weights, 1e-9);
  }
}

TEST(DecisionTimer, CountsStepsAndDecidesAtTheFirst) {
  DecisionTimer timer(6, 0.01);
  EXPECT_EQ(timer.stepsPerDecision(), 600);
  // A million steps of 0.01 s: 1667 decisions, exactly one every 600 steps. A comparison of accumulated times would miss some.
  int decisions = 0;
  for (int step = 0; step < 1000000; ++step) {
    const bool due = timer.due();
    ASSERT_EQ(due, step % 600 == 0);
    decisions += due;
  }
  EXPECT_EQ(decisions, 1667);
}

TEST(DecisionTimer, RoundsToWholeStepsAtLeastOne) {
  EXPECT_EQ(DecisionTimer(0.025, 0.01).stepsPerDecision(), 3);
  EXPECT_EQ(DecisionTimer(0.024, 0.01).stepsPerDecision(), 2);
  EXPECT_EQ(DecisionTimer(0.001, 0.01).stepsPerDecision(), 1);
  EXPECT_EQ(DecisionTimer(0.3, 0.1).stepsPerDecision(), 3);
}

TEST(DecisionTimer, RejectsTimesThatCannotBeCounted) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(DecisionTimer(bad, 0.01), BadParameter);
    EXPECT_THROW(DecisionTimer(6, bad), BadParameter);
  }
  EXPECT_THROW(DecisionTimer(1e9, 1e-9), BadParameter);
  EXPECT_TRUE(contains(messageOf<BadParameter>([] { DecisionTimer(-6, 0.01); }), "decision interval = -6 s"));
}

}  // namespace
}  // namespace musclesim
