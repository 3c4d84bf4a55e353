/// The robot in Bullet: the way of the arm against musclesim's, both with short steps.
#include <gtest/gtest.h>

#include "hand_difference.h"
#include "musclesim/base/error.h"
#include "peers/engine.h"
#include "peers_fixture.h"

extern "C" const musclesim::peers::PeerEngine* musclesim_peer_bullet();

namespace musclesim::peers {
namespace {

double handDifferenceMm(const std::string& robot, const std::vector<std::string>& parameters, const std::string& method, int substeps) {
  Sample ours(robot, parameters, 200);
  const auto theirs = musclesim_peer_bullet()->make(ours.mechanism, ours.tree, {method, control_step_s / substeps});
  return handDifferenceMm(ours, *theirs, 0.1, substeps);
}

TEST(BulletPeer, LineMusclesMoveTheArmAlike) {
  EXPECT_LT(handDifferenceMm("arm", {"arm.muscle_count=10", "muscle.model=line"}, "SequentialImpulse 50", 200), 3);
}

TEST(BulletPeer, AChainMovesTheRigAlike) {
  EXPECT_LT(handDifferenceMm("rig", {"muscle.joint_friction=viscous"}, "SequentialImpulse 250", 400), 1);
}

TEST(BulletPeer, RefusesPulleys) {
  const Sample arm("pulley_arm");
  EXPECT_THROW(musclesim_peer_bullet()->make(arm.mechanism, arm.tree, {"NNCG 50", control_step_s}), Error);
}

}  // namespace
}  // namespace musclesim::peers
