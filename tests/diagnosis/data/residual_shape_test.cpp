// The shape of a residual.
#include "diagnosis/data/residual_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "musclesim/base/random.h"

namespace musclesim {
namespace {

/// 8 s with 100 rows per second; the measured values have noise of 0.1.
ResidualDescription lookAt(const std::function<double(double)>& residual, double jump_s = 0) {
  RandomStream random(5, "residual");
  std::vector<double> time_s, measured, simulated;
  for (int row = 0; row < 800; ++row) {
    const double t = 0.01 * row + (row > 400 ? jump_s : 0);
    time_s.push_back(t);
    simulated.push_back(std::sin(t));
    measured.push_back(std::sin(t) + residual(t) + 0.1 * random.normal());
  }
  return describeResidual(time_s, measured, simulated);
}

TEST(ResidualDescription, NamesTheShapeThatMakesMostOfIt) {
  const ResidualDescription offset = lookAt([](double) { return -0.4; }), drift = lookAt([](double t) { return 0.2 * (t - 4); }),
                            ripple = lookAt([](double t) { return 0.5 * std::sin(2 * std::numbers::pi * 4.63 * t); });
  EXPECT_EQ(offset.shape, ResidualShape::offset);
  EXPECT_NEAR(offset.value, -0.4, 0.02);
  EXPECT_EQ(drift.shape, ResidualShape::drift);
  EXPECT_NEAR(drift.value, 0.2, 0.01);
  EXPECT_EQ(ripple.shape, ResidualShape::ripple);
  EXPECT_NEAR(ripple.value, 4.63, 0.05);
  EXPECT_EQ(wordsFor(ripple), "mostly a ripple of 4.6 Hz");
}

TEST(ResidualDescription, FollowsARippleThatWanders) {
  const ResidualDescription ripple = lookAt([](double t) { return 0.5 * std::sin(2 * std::numbers::pi * (5 * t + 0.05 * std::sin(t))); });
  EXPECT_EQ(ripple.shape, ResidualShape::ripple);
  EXPECT_NEAR(ripple.value, 5, 0.2);
}

TEST(ResidualDescription, NamesNothingInNoiseOrInWhatFollowsTheCommands) {
  EXPECT_EQ(lookAt([](double) { return 0.0; }).shape, ResidualShape::none);
  EXPECT_EQ(lookAt([](double t) { return std::sin(2 * std::numbers::pi * 0.5 * t); }).shape, ResidualShape::none);
  EXPECT_EQ(wordsFor({}), "");
}

TEST(ResidualDescription, DoesNotGuessWhereRowsAreMissing) {
  EXPECT_EQ(lookAt([](double t) { return 0.5 * std::sin(2 * std::numbers::pi * 4.63 * t); }, 0.5).shape, ResidualShape::none);
  EXPECT_EQ(describeResidual({0, 0.01}, {1, 1}, {0, 0}).shape, ResidualShape::none);
}

}  // namespace
}  // namespace musclesim
