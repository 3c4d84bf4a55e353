/// The friction that braid and joints share, against its differential equation.
#include "effect/presliding.h"

#include <gtest/gtest.h>

namespace musclesim {
namespace {

TEST(Presliding, SolvesItsEquation) {
  for (const double exponent : {0.0, 0.3, 0.5, 1.0})
    for (const double start : {-1.0, -0.4, 0.6, 1.0})
      for (const double way : {0.7, -0.7, 1.6}) {
        constexpr int steps = 200'000;
        const double direction = way < 0 ? -1 : 1, dx = way / steps;
        double z = start;
        for (int i = 0; i < steps; ++i) z = std::clamp(z + std::pow(std::max(0.0, 1 - direction * z), exponent) * dx, -1.0, 1.0);
        EXPECT_NEAR(slid(start, way, exponent), z, 2e-5) << exponent << " " << start << " " << way;
      }
}

TEST(Presliding, DoesNotDependOnTheSteps) {
  for (const double exponent : {0.0, 0.5, 1.0}) {
    double z = -0.8;
    for (int i = 0; i < 100; ++i) z = slid(z, 0.012, exponent);
    EXPECT_NEAR(z, slid(-0.8, 1.2, exponent), 1e-12) << exponent;
    EXPECT_LE(slid(0.9, 50, exponent), 1);
    EXPECT_GE(slid(0.9, -50, exponent), -1);
  }
}

}  // namespace
}  // namespace musclesim
