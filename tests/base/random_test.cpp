#include "musclesim/base/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace musclesim {
namespace {

TEST(RandomStream, SameSeedAndOwnerGiveSameNumbers) {
  RandomStream a(7, "asm.noise"), b(7, "asm.noise");
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.normal(), b.normal());
}

TEST(RandomStream, OwnersAndSeedsAreUnrelated) {
  RandomStream a(7, "asm.noise"), b(7, "asm.attractors"), c(8, "asm.noise");
  double correlation_ab = 0, correlation_ac = 0;
  const int count = 20000;
  for (int i = 0; i < count; ++i) {
    const double x = a.normal();
    correlation_ab += x * b.normal() / count;
    correlation_ac += x * c.normal() / count;
  }
  EXPECT_LT(std::abs(correlation_ab), 4.0 / std::sqrt(count));
  EXPECT_LT(std::abs(correlation_ac), 4.0 / std::sqrt(count));
}

TEST(RandomStream, MomentsOfTheDistributions) {
  RandomStream stream(1, "test");
  const int count = 100000;
  double mean = 0, square = 0, uniform_mean = 0;
  for (int i = 0; i < count; ++i) {
    const double x = stream.normal();
    mean += x / count;
    square += x * x / count;
    const double u = stream.uniform(-1, 3);
    ASSERT_GE(u, -1);
    ASSERT_LT(u, 3);
    uniform_mean += u / count;
  }
  EXPECT_NEAR(mean, 0, 4 / std::sqrt(count));
  EXPECT_NEAR(square, 1, 4 * std::sqrt(2.0 / count));
  EXPECT_NEAR(uniform_mean, 1, 4 * 4 / std::sqrt(12.0 * count));
}

}  // namespace
}  // namespace musclesim
