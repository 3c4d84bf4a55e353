// The two-joint arm whose cables run around drums.
#include <gtest/gtest.h>

#include <numbers>

#include "musclesim/simulation/simulation.h"

namespace musclesim {
namespace {

constexpr double drum_mm = 25;

/// Muscles: shoulder_front, shoulder_back, elbow_front, elbow_back, both_front, both_back.
State settled(const std::vector<double>& pressures) {
  Simulation simulation;
  Robot& robot = simulation.build("pulley_arm");
  simulation.settle(pressures);
  return robot.getState();
}

double radians(double deg) {
  return deg * std::numbers::pi / 180;
}

TEST(PulleyArm, HangsDownUnderEqualPressures) {
  const State state = settled({0.4, 0.4, 0.4, 0.4, 0.4, 0.4});
  EXPECT_NEAR(state.angle_deg[0], 0, 1e-6);
  EXPECT_NEAR(state.angle_deg[1], 0, 1e-6);
}

TEST(PulleyArm, AMusclePullsItsJointForwardsByTheRadiusOfItsDrum) {
  const State rest = settled({0.4, 0.4, 0.4, 0.4, 0.4, 0.4}), moved = settled({0.6, 0.3, 0.7, 0.2, 0.2, 0.2});
  EXPECT_GT(moved.angle_deg[0], 0.5);
  EXPECT_GT(moved.angle_deg[1], 0.5);
  for (const std::size_t joint : {0u, 1u}) {
    const double turned = radians(moved.angle_deg[joint] - rest.angle_deg[joint]);
    EXPECT_NEAR(moved.length_mm[2 * joint] - rest.length_mm[2 * joint], -drum_mm * turned, 1e-6);
    EXPECT_NEAR(moved.length_mm[2 * joint + 1] - rest.length_mm[2 * joint + 1], drum_mm * turned, 1e-6);
  }
}

TEST(PulleyArm, TheLongPairTurnsBothJoints) {
  const State moved = settled({0.3, 0.3, 0.3, 0.3, 0.6, 0.2});
  EXPECT_GT(moved.angle_deg[0], 2);
  EXPECT_GT(moved.angle_deg[1], 2);
  EXPECT_GT(moved.length_mm[5], moved.length_mm[4] + drum_mm * radians(moved.angle_deg[0] + moved.angle_deg[1]));
}

}  // namespace
}  // namespace musclesim
