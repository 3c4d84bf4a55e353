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
ResidualDescription lookAt(
    const std::function<double(double)>& residual, double jump_s = 0,
    const std::function<double(double)>& signal = [](double t) { return std::sin(t); }) {
  RandomStream random(5, "residual");
  std::vector<double> time_s, measured, simulated;
  for (int row = 0; row < 800; ++row) {
    const double t = 0.01 * row + (row > 400 ? jump_s : 0);
    time_s.push_back(t);
    simulated.push_back(signal(t));
    measured.push_back(signal(t) + residual(t) + 0.1 * random.normal());
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

TEST(ResidualDescription, TellsHowEarlyOrLateASignalComes) {
  const auto signal = [](double t) { return 3 * std::sin(t + std::sin(3 * t)); };
  const auto shifted = [&](double by_s) { return lookAt([&](double t) { return signal(t - by_s) - signal(t); }, 0, signal); };
  EXPECT_EQ(shifted(-0.13).shape, ResidualShape::shift);
  EXPECT_NEAR(shifted(-0.13).value, -0.13, 0.011);
  EXPECT_NEAR(shifted(0.3).value, 0.3, 0.011);
  EXPECT_EQ(wordsFor(shifted(0.3)), "mostly because it comes 0.3 s late");
  EXPECT_EQ(shifted(0).shape, ResidualShape::none);
  const ResidualDescription with_a_pause = lookAt([&](double t) { return signal(t + 0.13) - signal(t); }, 0.5, signal);
  EXPECT_NEAR(with_a_pause.value, -0.13, 0.011);
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
