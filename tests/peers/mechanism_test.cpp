#include "peers/mechanism.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "../../robot/springs.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/actuator.h"
#include "peers/muscle_forces.h"
#include "peers_fixture.h"

namespace musclesim::peers {
namespace {

TEST(Mechanism, HoldsTheChainOfTheRig) {
  const Sample rig("rig");
  // 120 mm of beads with a diameter of 15 mm are eight links.
  ASSERT_EQ(rig.mechanism.bodies.size(), 1U + 16U);
  EXPECT_DOUBLE_EQ(rig.mechanism.bodies[0].mass_kg, 2);
  EXPECT_DOUBLE_EQ(rig.mechanism.bodies[1].mass_kg, 0.01);
  EXPECT_NEAR(rig.mechanism.bodies[1].inertia_kg_m2(1, 1), 0.4 * 0.01 * 0.0075 * 0.0075, 1e-18);
  EXPECT_DOUBLE_EQ(rig.mechanism.gravity_m_per_s2, 9.81);
  const MuscleParts& muscle = rig.mechanism.muscles.at(0);
  ASSERT_EQ(muscle.sliders.size(), 8U);
  EXPECT_EQ(muscle.hinges.size(), 7U);
  EXPECT_NEAR(muscle.length_m, 0.21, 1e-12);
  const BodyJoint& slider = rig.mechanism.joints[static_cast<std::size_t>(muscle.sliders[0])];
  EXPECT_DOUBLE_EQ(slider.axes.at(0).friction, 1);
  // A link of 210/8 mm may grow to 300/8 mm and shrink to 15 mm; its coordinate grows as it shrinks.
  EXPECT_NEAR(slider.axes[0].low, (210 - 300) / 8.0 / 1000, 1e-12);
  EXPECT_NEAR(slider.axes[0].high, (210 / 8.0 - 15) / 1000, 1e-12);
  const BodyJoint& hinge = rig.mechanism.joints[static_cast<std::size_t>(muscle.hinges[0])];
  EXPECT_DOUBLE_EQ(hinge.axes.at(0).friction, 0.008);
}

TEST(Mechanism, TakesViscousFrictionAsDamping) {
  const Sample rig("rig", {"muscle.joint_friction=viscous"});
  const MuscleParts& muscle = rig.mechanism.muscles.at(0);
  const JointAxis& slider = rig.mechanism.joints[static_cast<std::size_t>(muscle.sliders[0])].axes.at(0);
  EXPECT_NEAR(slider.damping, 1 / 0.2, 1e-9);  // 1 N at 200 mm/s
  EXPECT_EQ(slider.friction, 0);
  EXPECT_NEAR(rig.mechanism.joints[static_cast<std::size_t>(muscle.hinges[0])].axes.at(0).damping, 0.008 / 8, 1e-12);
}

TEST(Mechanism, TakesTheDampingOfAJointAlsoBesideDryFriction) {
  Sample elbow("elbow");
  Joint& joint = *elbow.simulation.robot().angles().at(0).joint;
  addJointMechanics(elbow.simulation.world(), joint, {.damping = 0.05});
  const auto axis = [&] {
    elbow.read();
    const auto read = std::ranges::find(elbow.mechanism.joints, &joint, &BodyJoint::source);
    return read == elbow.mechanism.joints.end() ? JointAxis{} : read->axes.at(0);
  };
  EXPECT_NEAR(axis().damping, 0.05, 1e-12);
  EXPECT_EQ(axis().friction, 0);
  joint.addDryFriction(0.3 * mm_per_m * elbow.simulation.physics().force_per_N);
  EXPECT_NEAR(axis().damping, 0.05, 1e-12);
  EXPECT_NEAR(axis().friction, 0.3, 1e-12);
}

TEST(Mechanism, CountsStopsFromThePresentPose) {
  Sample elbow("elbow");
  const auto limits = [&] {
    for (const BodyJoint& joint : elbow.mechanism.joints)
      if (joint.kind == Joint::Kind::hinge && joint.second == environment) return joint.axes.at(0);
    return JointAxis{};
  };
  EXPECT_NEAR(limits().high, 70 * rad_per_deg, 1e-9);
  elbow.simulation.settle({0.2, 0.7});
  elbow.read();
  const double angle_rad = elbow.simulation.robot().getState().angle_deg.at(0) * rad_per_deg;
  ASSERT_GT(std::abs(angle_rad), 0.05);
  EXPECT_NEAR(limits().high, 70 * rad_per_deg - angle_rad, 1e-6);
  EXPECT_NEAR(limits().low, -70 * rad_per_deg - angle_rad, 1e-6);
}

TEST(Mechanism, MakesOneHingeOfTwoBallsBetweenTheSameBones) {
  const Sample arm("arm", {"arm.muscle_count=1", "muscle.model=line"});
  int balls = 0;
  for (const BodyJoint& joint : arm.mechanism.joints)
    if (joint.kind == Joint::Kind::ball && joint.first != joint.second) ++balls;
  EXPECT_EQ(balls, 1);  // the shoulder
  EXPECT_TRUE(arm.tree.loops.empty());
}

TEST(Mechanism, KnowsWhereTheHandIs) {
  Sample arm("arm", {"arm.muscle_count=2", "muscle.model=line"});
  EXPECT_LT((arm.mechanism.inWorld(arm.mechanism.hand) * 1000 - arm.simulation.robot().handMm()).norm(), 1e-9);
}

TEST(Mechanism, OfOriginalPhysicsIsRefused) {
  SimulationOptions options;
  options.physics = PhysicsKind::original;
  Simulation simulation(std::move(options));
  simulation.build("rig");
  EXPECT_THROW(mechanismOf(simulation), BadParameter);
}

TEST(SpanningTree, ReachesEveryBodyOnceAndParentsFirst) {
  const Sample arm("arm", {"arm.muscle_count=10"});
  std::set<int> reached = {environment};
  for (const TreeNode& node : arm.tree.nodes) {
    EXPECT_TRUE(reached.contains(node.parent));
    EXPECT_TRUE(reached.insert(node.body).second);
  }
  EXPECT_EQ(reached.size(), arm.mechanism.bodies.size() + 1);
  EXPECT_EQ(arm.tree.loops.size(), 10U);  // one per muscle
  // The first muscle runs from the moving humerus to a rib, which is fixed: it hangs on the rib.
  EXPECT_EQ(arm.tree.loops.front(), arm.mechanism.muscles.front().start_joint);
}

TEST(MuscleForces, AreThoseOfTheSimulation) {
  Sample rig("rig");
  rig.simulation.start("built", {0.6});
  const Actuator& actuator = *rig.simulation.robot().actuators().at(0);
  EXPECT_NEAR(tensionN(actuator, 0.6, actuator.lengthMm() / 1000), rig.simulation.robot().truth().force_N.at(0), 1e-9);
  EXPECT_NEAR(hingeStopRad(actuator, 0.21), std::numbers::pi / 3 * 0.5, 1e-12);  // half way from 120 to 300 mm
  EXPECT_NEAR(lineForceN(actuator, 0, 0.302, 0.1) - tensionN(actuator, 0, 0.302), std::tanh(1.0) + 20, 1e-9);
}

}  // namespace
}  // namespace musclesim::peers
