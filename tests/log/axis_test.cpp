#include "log/axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace musclesim {
namespace {

Extent extent(const std::vector<double>& values) {
  Extent result;
  result.add(values);
  return result;
}

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> out;
  for (const double tick : axis.ticks()) out.push_back(axis.label(tick));
  return out;
}

TEST(Extent, SkipsWhatIsNotFinite) {
  const auto result = extent({std::nan(""), 3, -1, std::numeric_limits<double>::infinity()});
  EXPECT_EQ(result.minimum(), -1);
  EXPECT_EQ(result.maximum(), 3);
  EXPECT_TRUE(extent({std::nan("")}).empty());
}

TEST(Axis, RoundEndsAndTicks) {
  const Axis axis(extent({-237, 12}), 300, 0, 6, true);
  EXPECT_EQ(labels(axis), (std::vector<std::string>{"\u2212250", "\u2212200", "\u2212150", "\u2212100", "\u221250", "0", "50"}));
  EXPECT_DOUBLE_EQ(axis.pixel(-250), 300);
  EXPECT_DOUBLE_EQ(axis.pixel(50), 0);
  EXPECT_DOUBLE_EQ(axis.pixel(-100), 150);
}

TEST(Axis, FractionsAndExactEnds) {
  EXPECT_EQ(labels(Axis(extent({0, 1}), 0, 1, 5, true)), (std::vector<std::string>{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  const Axis time(extent({0, 292}), 0, 600, 10, false);
  EXPECT_EQ(time.maximum(), 292);
  EXPECT_EQ(labels(time), (std::vector<std::string>{"0", "50", "100", "150", "200", "250"}));
}

TEST(Axis, AnEndNearATickMovesThere) {
  const Axis time(extent({0.01, 299.99}), 0, 600, 10, false);
  EXPECT_EQ(time.minimum(), 0);
  EXPECT_EQ(time.maximum(), 300);
}

TEST(Axis, OddExtentsGetTicksThatDiffer) {
  const double largest = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  for (const auto& values : std::vector<std::vector<double>>{{},
                                                             {0},
                                                             {5},
                                                             {-5},
                                                             {1e-300},
                                                             {1e300},
                                                             {-largest, largest},
                                                             {0, least},
                                                             {1, 1 + 1e-15},
                                                             {1.7e9, 1.7e9 + 10},
                                                             {1e-7, 2e-7},
                                                             {-1e12, 3e12}}) {
    for (const bool round_ends : {true, false}) {
      const Axis axis(extent(values), 0, 100, 6, round_ends);
      ASSERT_GE(axis.ticks().size(), 1u);
      ASSERT_LE(axis.ticks().size(), 25u);
      for (const double value : values) {
        EXPECT_TRUE(std::isfinite(axis.pixel(value)));
        EXPECT_GE(axis.pixel(value), -1e-6);
        EXPECT_LE(axis.pixel(value), 100 + 1e-6);
      }
      const auto names = labels(axis);
      for (std::size_t i = 1; i < names.size(); ++i) EXPECT_NE(names[i], names[i - 1]);
    }
  }
}

}  // namespace
}  // namespace musclesim
