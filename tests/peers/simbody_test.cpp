/// The robot in Simbody: the way of the arm against musclesim's, both with short steps.
#include <gtest/gtest.h>

#include "hand_difference.h"
#include "musclesim/base/error.h"
#include "peers/engine.h"
#include "peers_fixture.h"

extern "C" const musclesim::peers::PeerEngine* musclesim_peer_simbody();

namespace musclesim::peers {
namespace {

double handDifferenceMm(const std::string& robot, const std::vector<std::string>& parameters, const std::string& method, int substeps) {
  Sample ours(robot, parameters, 200);
  const auto theirs = musclesim_peer_simbody()->make(ours.mechanism, ours.tree, {method, control_step_s / substeps});
  return handDifferenceMm(ours, *theirs, 0.1, substeps);
}

TEST(SimbodyPeer, LineMusclesMoveTheArmAlike) {
  // The elbow begins at its stop, which is a spring there.
  EXPECT_LT(handDifferenceMm("arm", {"arm.muscle_count=10", "muscle.model=line"}, "RungeKutta3", 100), 12);
}

TEST(SimbodyPeer, AChainMovesTheRigAlike) {
  EXPECT_LT(handDifferenceMm("rig", {"muscle.joint_friction=viscous"}, "RungeKuttaMerson", 200), 1);
}

TEST(SimbodyPeer, RefusesPulleys) {
  const Sample arm("pulley_arm");
  EXPECT_THROW(musclesim_peer_simbody()->make(arm.mechanism, arm.tree, {"Verlet", control_step_s}), Error);
}

}  // namespace
}  // namespace musclesim::peers
