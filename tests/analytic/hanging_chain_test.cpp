/// A chain that hangs at rest and carries its own weight and a load.
#include <gtest/gtest.h>

#include "musclesim/robot/muscle.h"
#include "static_rig.h"

namespace musclesim {
namespace {

TEST(HangingChain, SettlesWhereForceCarriesTheLoadAndHalfTheChain) {
  SimulationOptions options;
  options.parameters.set("muscle.slider_friction_N", 0.0, "test");
  options.parameters.set("muscle.hinge_friction_Nm", 0.0, "test");
  Simulation simulation(options);
  Robot& robot = simulation.build("rig");
  simulation.settle({0.6});
  // Eq. 1 solved by hand in decimal arithmetic: F = (2 + 0.16 / 2) kg * 9.81 m/s^2 at p = 0.6.
  EXPECT_NEAR(robot.getState().length_mm[0], 183.43977198, 1e-6);
}

TEST(HangingChain, ItsFixedPointCarriesTheWeightOfChainAndLoad) {
  SimulationOptions options;
  options.substeps = 5;
  options.stepper = StepperKind::ode;  // only this stepper reports the joints' forces
  Simulation simulation(options);
  Robot& robot = simulation.build("rig");
  simulation.start("settled", {0.6});
  dJointFeedback top = {}, bottom = {};
  dJointSetFeedback(robot.actuators()[0]->startJoint()->id(), &top);
  dJointSetFeedback(robot.actuators()[0]->endJoint()->id(), &bottom);
  simulation.advance(0.5);
  EXPECT_NEAR(top.f1[1] / world_force_per_N, (2 + 0.16) * gravity_m_per_s2, 0.01);
  EXPECT_NEAR(bottom.f1[1] / world_force_per_N, -2 * gravity_m_per_s2, 0.01);
  EXPECT_NEAR(top.f1[0], 0, 1e3);
  EXPECT_NEAR(top.f1[2], 0, 1e3);
}

TEST(HangingChain, WithoutForceAndFrictionItHangsAtItsFullLength) {
  SimulationOptions options;
  options.substeps = 5;
  options.parameters.set("muscle.slider_friction_N", 0.0, "test");
  options.parameters.set("force_law.c_kgf", 0.0, "test");
  Simulation simulation(options);
  auto* muscle = new Muscle(simulation.world(), simulation.space(), {0, 0, 0}, {0, -80, 0}, {0, -160, 0}, {0, -240, 0}, 120, 300);
  muscle->connectStartTo(nullptr);
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_NEAR(muscle->lengthMm(), 300, 0.1);
  for (const Link& link : muscle->links()) {
    const dReal *upper = dBodyGetPosition(link.bead[0]), *lower = dBodyGetPosition(link.bead[1]);
    EXPECT_NEAR(upper[1] - lower[1], 300.0 / 8 - 15, 0.02);
    EXPECT_NEAR(upper[0], 0, 1e-6);
  }
}

TEST(HangingChain, HeavierBeadsHangLongerByTheirWeightOverTheStiffness) {
  auto length_mm = [](double bead_g) {
    SimulationOptions options;
    options.parameters.set("muscle.bead_mass_g", bead_g, "test");
    Simulation simulation(options);
    Robot& robot = simulation.build("rig");
    simulation.settle({0.6});
    return robot.getState().length_mm[0];
  };
  const double stiffness = BraunForceLaw(120, 300).stiffnessNPerMm(0.6, 183.29);
  EXPECT_NEAR(length_mm(12) - length_mm(10), 8 * 0.002 * gravity_m_per_s2 / stiffness, 0.01);
}

}  // namespace
}  // namespace musclesim
