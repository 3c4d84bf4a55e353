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

TEST(RestFrom, FindsTheFirstRootOnTheWayItIsPushed) {
  auto wave = [](double x) { return std::sin(x); };
  EXPECT_NEAR(restFrom(wave, 0.5, -6, 6), 0, 1e-15);
  EXPECT_NEAR(restFrom(wave, 4, -6, 7), 2 * M_PI, 1e-15);
  EXPECT_NEAR(restFrom(wave, -2, -6, 6), 0, 1e-15);
  EXPECT_DOUBLE_EQ(restFrom([](double x) { return x * x - 2; }, 0, 0, 2), std::sqrt(2.0));
}

TEST(RootBetween, NeedsFewValuesOfASmoothFunction) {
  int count = 0;
  EXPECT_DOUBLE_EQ(rootBetween(
                       [&count](double x) {
                         ++count;
                         return std::exp(x) - 2;
                       },
                       0, 3),
                   std::log(2.0));
  EXPECT_LT(count, 30);
}

TEST(RestFrom, SearchesRangesWithoutEnds) {
  const double open = INFINITY;
  EXPECT_DOUBLE_EQ(restFrom([](double x) { return x - 5000; }, 0, -open, open), 5000);
  EXPECT_DOUBLE_EQ(restFrom([](double x) { return x + 3; }, 2, -open, 7), -3);
  EXPECT_EQ(restFrom([](double) { return 1.0; }, 0, -open, open), -open);
  EXPECT_EQ(restFrom([](double) { return -1.0; }, 0, -open, 4), 4);
}

TEST(RestFrom, EndsAtTheEndItIsPushedTo) {
  EXPECT_EQ(restFrom([](double x) { return std::sin(x); }, 4, -6, 6), 6);
  EXPECT_EQ(restFrom([](double) { return 1.0; }, 0, -0.1, 0.7), -0.1);
  EXPECT_EQ(restFrom([](double) { return -1.0; }, 0, 0.2, 0.7), 0.7) << "a start out of range";
}

}  // namespace
}  // namespace musclesim
