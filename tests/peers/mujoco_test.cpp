/// The robot in MuJoCo: falls and ways of the arm against musclesim's, both with short steps.
#include <gtest/gtest.h>

#include <cmath>

#include "hand_difference.h"
#include "musclesim/base/error.h"
#include "peers/engine.h"
#include "peers/own.h"
#include "peers_fixture.h"

extern "C" const musclesim::peers::PeerEngine* musclesim_peer_mujoco();

namespace musclesim::peers {
namespace {

double handDifferenceMm(const std::string& robot, const std::vector<std::string>& parameters, double duration_s, int substeps) {
  Sample ours(robot, parameters, substeps);
  const auto theirs =
      musclesim_peer_mujoco()->make(ours.mechanism, ours.tree, {musclesim_peer_mujoco()->methods.front(), control_step_s / substeps});
  return handDifferenceMm(ours, *theirs, duration_s, substeps);
}

TEST(MujocoPeer, LineMusclesMoveTheArmAlike) {
  EXPECT_LT(handDifferenceMm("arm", {"arm.muscle_count=10", "muscle.model=line"}, 0.2, 400), 3);
}

TEST(MujocoPeer, AChainMovesTheRigAlike) {
  EXPECT_LT(handDifferenceMm("rig", {"muscle.joint_friction=viscous"}, 0.2, 100), 0.1);
}

TEST(MujocoPeer, PulleysAndTendonsActAlike) {
  Sample arm("pulley_arm", {}, 50);
  const auto theirs = musclesim_peer_mujoco()->make(arm.mechanism, arm.tree, {"Euler, Newton", control_step_s / 50});
  const Action command = {0.3, 0.1, 0.4, 0.2, 0.5, 0.3};
  int joint = 0;
  while (arm.mechanism.joints[static_cast<std::size_t>(joint)].kind != Joint::Kind::hinge) ++joint;
  double worst_deg = 0, widest_deg = 0;
  for (int i = 0; i < 30; ++i) {
    arm.simulation.robot().step(command);
    arm.simulation.step();
    theirs->advance(command, 50);
    const double there_deg = theirs->coordinate(joint) / rad_per_deg;
    const double here_deg = arm.mechanism.joints[static_cast<std::size_t>(joint)].source->angleDeg();
    worst_deg = std::max(worst_deg, std::abs(there_deg - here_deg));
    widest_deg = std::max(widest_deg, std::abs(here_deg));
  }
  EXPECT_GT(widest_deg, 4);
  EXPECT_LT(worst_deg, 0.02);
}

TEST(MujocoPeer, SaysThatItDiverged) {
  Sample arm("arm", {"arm.muscle_count=10"});
  const auto theirs = musclesim_peer_mujoco()->make(arm.mechanism, arm.tree, {"Euler, Newton", control_step_s});
  EXPECT_THROW(theirs->advance(Action(10, 1.0), 100), Error);
}

}  // namespace
}  // namespace musclesim::peers
