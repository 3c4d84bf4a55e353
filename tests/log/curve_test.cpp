#include "log/curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace musclesim {
namespace {

Axis axisOf(double minimum, double maximum, double pixels) {
  Extent extent;
  extent.add(minimum);
  extent.add(maximum);
  return {extent, 0, pixels, 5, false};
}

const double gap = std::nan("");

TEST(Curve, NanSplitsIntoPieces) {
  const auto pieces = curvePieces({0, 1, 2, 3, 4, 5}, {gap, 1, 2, gap, 3, gap}, axisOf(0, 5, 500), axisOf(0, 10, 100), Between::straight);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].size(), 2u);
  EXPECT_EQ(pieces[0][1].x, 200);
  EXPECT_EQ(pieces[0][1].y, 20);
  EXPECT_EQ(pieces[1].size(), 1u);
}

TEST(Curve, HeldValuesMakeSteps) {
  const auto pieces = curvePieces({0, 1, 2}, {1, 1, 5}, axisOf(0, 2, 200), axisOf(0, 10, 100), Between::held);
  ASSERT_EQ(pieces.size(), 1u);
  ASSERT_EQ(pieces[0].size(), 4u);
  EXPECT_EQ(pieces[0][2].x, 200);
  EXPECT_EQ(pieces[0][2].y, 10);
  EXPECT_EQ(pieces[0][3].y, 50);
}

TEST(Curve, ThinningKeepsASpikeOfOneSample) {
  std::vector<double> time_s, values;
  for (int i = 0; i < 100'000; ++i) {
    time_s.push_back(i);
    values.push_back(i == 54'321 ? 9 : i == 54'322 ? 1 : 5);
  }
  const auto pieces = curvePieces(time_s, values, axisOf(0, 99'999, 800), axisOf(0, 10, 100), Between::straight);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_LE(pieces[0].size(), 2 * 801u);
  int high = 0, low = 0;
  for (std::size_t i = 0; i < pieces[0].size(); ++i) {
    high += pieces[0][i].y == 90;
    low += pieces[0][i].y == 10;
    EXPECT_GE(pieces[0][i].x, pieces[0][i > 0 ? i - 1 : 0].x) << "in the order of time";
  }
  EXPECT_EQ(high, 1);
  EXPECT_EQ(low, 1);
}

}  // namespace
}  // namespace musclesim
