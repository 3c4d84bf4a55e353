#include "equilibrium.h"

#include <gtest/gtest.h>

#include <cmath>

namespace musclesim {
namespace {

TEST(RootBetween, FindsTheRootToTheLastBit) {
  EXPECT_DOUBLE_EQ(rootBetween([](double x) { return x * x - 2; }, 0, 2), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(rootBetween([](double x) { return x + 3; }, -10, 10), -3);
  EXPECT_NEAR(rootBetween([](double x) { return std::sin(x); }, -1, 1.5), 0, 1e-300) << "roots at 0 have no last bit";
}

TEST(RootBetween, GivesTheNearerEndWithoutAChangeOfSign) {
  EXPECT_EQ(rootBetween([](double x) { return x + 3; }, 1, 2), 1);
  EXPECT_EQ(rootBetween([](double x) { return x - 3; }, 1, 2), 2);
}

TEST(RootBetween, TakesAStepAsWell) {
  EXPECT_NEAR(rootBetween([](double x) { return x < 0.3 ? -1.0 : 1.0; }, 0, 1), 0.3, 1e-15);
}

}  // namespace
}  // namespace musclesim
