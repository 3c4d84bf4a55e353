/// The robot in Simbody: the way of the arm against musclesim's, both with short steps.
#include <gtest/gtest.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/random.h"
#include "peers/engine.h"
#include "peers_fixture.h"

extern "C" const musclesim::peers::PeerEngine* musclesim_peer_simbody();

namespace musclesim::peers {
namespace {

constexpr double control_step_s = 0.01;

/// The largest distance of the two hands within 0.1 s under random pressures.
double handDifferenceMm(const std::string& robot, const std::vector<std::string>& parameters, const std::string& method, int substeps) {
  Sample ours(robot, parameters, 200);
  const auto theirs = musclesim_peer_simbody()->make(ours.mechanism, ours.tree, {method, control_step_s / substeps});
  RandomStream random(3, "test");
  Action command(ours.mechanism.muscles.size());
  for (double& pressure : command) pressure = random.uniform();
  double worst_mm = 0;
  for (int i = 0; i < 10; ++i) {
    ours.simulation.robot().step(command);
    ours.simulation.step();
    theirs->advance(command, substeps);
    worst_mm = std::max(worst_mm, (theirs->handM() * 1000 - ours.simulation.robot().handMm()).norm());
  }
  EXPECT_LT(theirs->gapM(), 1e-3);
  return worst_mm;
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
