#include "../../evaluation/out_of_catalogue/wander.h"

#include <gtest/gtest.h>

#include <cmath>

namespace musclesim::out_of_catalogue {
namespace {

TEST(Wander, RunsStraightBetweenItsDraws) {
  for (int i = 0; i < 5; ++i) {
    const double first = wander(3, 2.0 * i, 2), last = wander(3, 2.0 * (i + 1), 2);
    EXPECT_NEAR(wander(3, 2.0 * i + 0.5, 2), 0.75 * first + 0.25 * last, 1e-12);
    EXPECT_NEAR(wander(3, 2.0 * i + 1.5, 2), 0.25 * first + 0.75 * last, 1e-12);
  }
}

TEST(Wander, DrawsUniformlyBetweenMinusOneAndOne) {
  constexpr int draw_count = 2000;
  double sum = 0, squares = 0;
  for (int i = 0; i < draw_count; ++i) {
    const double value = wander(7, i, 1);
    EXPECT_LE(std::abs(value), 1);
    sum += value;
    squares += value * value;
  }
  // Four standard errors of the mean (variance 1/3) and of the mean square (variance 4/45).
  EXPECT_NEAR(sum / draw_count, 0, 4 * std::sqrt(1.0 / 3 / draw_count));
  EXPECT_NEAR(squares / draw_count, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / draw_count));
}

TEST(Wander, DependsOnTheSeedAlone) {
  EXPECT_EQ(wander(1, 0.3, 1), wander(1, 0.3, 1));
  EXPECT_NE(wander(1, 0.3, 1), wander(2, 0.3, 1));
}

}  // namespace
}  // namespace musclesim::out_of_catalogue
