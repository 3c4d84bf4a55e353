#include "diagnosis/data/loop_pairs.h"

#include <gtest/gtest.h>

#include <limits>

namespace musclesim {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(LoopPairs, ALengthGoesWithThePressureOfItsMuscle) {
  const std::string p0 = "pressure_0", p1 = "pressure_1", l1 = "length_1_mm", l2 = "length_2_mm";
  const std::vector<double> t = {0, 1, 2}, up = {0, 1, 2}, down = {2, 1, 0};
  EXPECT_EQ(loopPairs({{l1, t, up}, {p0, t, up}, {p1, t, down}, {l2, t, up}}), (Pairs{{2, 0}})) << "no pressure of muscle 2 is measured";
}

TEST(LoopPairs, AnAngleGoesWithThePressureThatItFollowsMost) {
  const std::string p0 = "pressure_0", p1 = "pressure_1", hip = "angle_hip_deg", knee = "angle_knee_deg";
  const std::vector<double> t = {0, 1, 2, 3}, wave = {0, 1, 0, 1}, ramp = {3, 2.1, 1, 0}, line = {0, 10, 20, 30}, swing = {5, 8, 5, 8.5};
  EXPECT_EQ(loopPairs({{p0, t, wave}, {p1, t, ramp}, {hip, t, line}, {knee, t, swing}}), (Pairs{{1, 2}, {0, 3}})) << "of either sign";
  EXPECT_EQ(loopPairs({{hip, t, line}}), Pairs{});
}

TEST(LoopPairs, SignalsAreComparedAtTheTimesThatBothHave) {
  const std::string p0 = "pressure_0", p1 = "pressure_1", knee = "angle_knee_deg";
  const std::vector<double> t = {0, 1, 2, 3}, half = {0, 2, 3}, wave = {0, 1, 0, 1}, of_half = {0, 2, 3}, angle = {0, missing, 2, 3};
  EXPECT_EQ(loopPairs({{p0, t, wave}, {p1, half, of_half}, {knee, t, angle}}), (Pairs{{1, 2}}));
}

}  // namespace
}  // namespace musclesim
