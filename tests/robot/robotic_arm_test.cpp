#include "musclesim/robot/robotic_arm.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

SimulationOptions with(const std::string& name, const Parameter::Value& value) {
  SimulationOptions options;
  if (!name.empty()) options.parameters.set(name, value, "test");
  return options;
}

Primitive* boneOf(const Simulation& simulation, const std::string& name) {
  for (const auto& primitive : simulation.world().primitives())
    if (primitive->name() == name) return primitive;
  throw BadParameter("no bone " + name);
}

const Joint* joint(const Simulation& simulation, const std::string& name) {
  for (const auto& candidate : simulation.world().joints())
    if (candidate->name() == name) return candidate.get();
  throw BadParameter("no joint " + name);
}

struct Expected {
  const char* bone;
  double mass_g;
  Vector center_mm;
  Vector exact;           ///< moments about the body's axes, g mm^2
  Vector exact_products;  ///< xy, xz, yz
  Vector summed;
};

/// The four moving composites. A separate program computed the values from the arm's table. A body has the axes of its parent part, so the
/// radius' z axis points along the bone, while the other bodies have the world's axes.
const Expected composites[] = {
    {"medius", 60, {-205.833333, -241.166667, 0}, {188805, 50578, 229583}, {5833.333, 0, 0}, {122537, 6370, 119107}},
    {"ulna", 140, {-195.714286, -2.142857, -4.285714}, {872867, 39125, 866999}, {65714.286, -8571.429, 49285.714}, {483287, 483607, 2669}},
    {"radius", 120, {-226.666667, -54.166667, 0}, {693892, 704264, 12508}, {0, -38333.333, 0}, {477180, 477180, 2136}},
    {"humerus", 260, {-210, 260, 0}, {3048169, 26315, 3048169}, {0, 0, 0}, {1698169, 1698169, 26315}},
};

void expectInertia(const PhysicsKind kind, const std::string& how, bool exact) {
  SimulationOptions options = how.empty() ? with("", 0.0) : with("arm.composite_inertia", how);
  options.physics = kind;
  Simulation simulation(options);
  simulation.build("arm");
  for (const Expected& expected : composites) {
    const Primitive* part = boneOf(simulation, expected.bone);
    dMass mass;
    dBodyGetMass(part->body().id, &mass);
    EXPECT_NEAR(mass.mass, expected.mass_g, 1e-9) << expected.bone;
    EXPECT_LT((part->getPosition() - expected.center_mm).norm(), 1e-5) << expected.bone;
    const Vector moments(mass.I[0], mass.I[5], mass.I[10]), products(mass.I[1], mass.I[2], mass.I[6]);
    const Vector none = Vector::Zero();
    EXPECT_LT((moments - (exact ? expected.exact : expected.summed)).cwiseAbs().maxCoeff(), 1)
        << expected.bone << " " << moments.transpose();
    EXPECT_LT((products - (exact ? expected.exact_products : none)).cwiseAbs().maxCoeff(), 1e-2)
        << expected.bone << " " << products.transpose();
  }
}

TEST(RoboticArm, CompositeInertiaIsExactInSiUnlessTold) {
  expectInertia(PhysicsKind::si, "", true);
  expectInertia(PhysicsKind::si, "summed", false);
}

TEST(RoboticArm, CompositeInertiaIsSummedInTheOriginalUnlessTold) {
  expectInertia(PhysicsKind::original, "", false);
  expectInertia(PhysicsKind::scaled, "", false);
  expectInertia(PhysicsKind::original, "exact", true);
}

TEST(RoboticArm, StartsInThePoseOfThePublishedProgram) {
  Simulation simulation;
  const State state = simulation.build("arm").getState();
  const double lengths_mm[] = {223.5926,   169.990503, 164.203211, 229.55795,  183.015308,
                               251.890733, 138.459671, 256.504845, 143.382445, 143.382445};
  ASSERT_EQ(state.length_mm.size(), 10u);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(state.length_mm[i], lengths_mm[i], 1e-5) << i;
  EXPECT_LT((*state.hand_mm - Vector(-205.833333, -241.166667, 0)).norm(), 1e-6);
  EXPECT_EQ(state.angle_deg.size(), 2u);
  EXPECT_NEAR(state.angle_deg[0], 0, 1e-9);
  EXPECT_NEAR(state.angle_deg[1], 0, 1e-9);
}

TEST(RoboticArm, ReportsTenMusclesTwoAnglesAndTheHand) {
  Simulation simulation;
  const Robot& robot = simulation.build("arm");
  const auto names = robot.signalNames();
  ASSERT_EQ(names.size(), 45u);
  EXPECT_EQ(names[0], "command_0");
  EXPECT_EQ(names[39], "length_9_mm");
  EXPECT_EQ(names[40], "angle_elbow_deg");
  EXPECT_EQ(names[41], "angle_wrist_deg");
  EXPECT_EQ(names[44], "hand_z_mm");
  EXPECT_EQ(robot.initialState(), "built");
  EXPECT_EQ(robot.actuators()[0]->color().name, "gray");
  for (const Actuator* muscle : robot.actuators()) {
    EXPECT_NE(muscle->startJoint(), nullptr);
    EXPECT_NE(muscle->endJoint(), nullptr);
  }
}

TEST(RoboticArm, HasElevenBodiesOfWhichFourMove) {
  Simulation simulation;
  simulation.build("arm");
  EXPECT_EQ(simulation.world().primitives().size(), 33u);
  EXPECT_EQ(simulation.world().bodies().size(), 11u);
  int fixed_count = 0;
  for (const auto& joint : simulation.world().joints()) fixed_count += joint->kind() == Joint::Kind::fixed;
  EXPECT_EQ(fixed_count, 7);
}

TEST(RoboticArm, IsWholeAsBuilt) {
  Simulation simulation(with("arm.muscle_count", 30.0));
  EXPECT_EQ(simulation.build("arm").actuatorCount(), 30);
  EXPECT_LT(simulation.largestGap().gap_mm, 1e-9);
}

TEST(RoboticArm, TakesTheFirstMusclesOfTheTable) {
  Simulation all;
  all.build("arm");
  for (const int count : {1, 4}) {
    Simulation simulation(with("arm.muscle_count", static_cast<double>(count)));
    const Robot& robot = simulation.build("arm");
    ASSERT_EQ(robot.actuatorCount(), count);
    for (int i = 0; i < count; ++i) EXPECT_EQ(robot.actuators()[i]->lengthMm(), all.robot().actuators()[i]->lengthMm());
  }
  for (const double wrong : {0.0, 31.0, 2.5, -1.0}) {
    Simulation simulation(with("arm.muscle_count", wrong));
    EXPECT_THROW(simulation.build("arm"), BadParameter) << wrong;
  }
}

/// Turns one hinge of the arm while the bone before it is held, and expects the hinge to reach its stop.
void expectStop(const std::string& held, const std::string& hinge, double torque_Nmm, double stop_deg) {
  SimulationOptions options = with("arm.muscle_count", 1.0);
  options.step_s = 3e-4;
  options.substeps = 1;
  options.parameters.set("physics.gravity_m_per_s2", 0.0, "test");
  Simulation simulation(options);
  simulation.build("arm");
  boneOf(simulation, held)->fix();
  simulation.start("built", {0.0});
  const Joint* turned = joint(simulation, hinge);
  for (int i = 0; i < 1500; ++i) {
    dJointAddHingeTorque(turned->id(), torque_Nmm * world_force_per_N);
    simulation.step();
    if (torque_Nmm > 0) {
      ASSERT_LT(turned->angleDeg(), stop_deg + 2);
    } else {
      ASSERT_GT(turned->angleDeg(), stop_deg - 2);
    }
  }
  EXPECT_NEAR(turned->angleDeg(), stop_deg, 0.5) << hinge;
}

TEST(RoboticArm, ElbowAndWristStopWhereTheTableSays) {
  expectStop("humerus", "hinge of ulna and elbow", 200, 0);
  expectStop("humerus", "hinge of ulna and elbow", -400, -90);
  expectStop("radius", "hinge of pollex and radius", 30, 60);
  expectStop("radius", "hinge of pollex and radius", -30, -60);
}

}  // namespace
}  // namespace musclesim
