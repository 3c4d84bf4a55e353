#include "../../simulation/internal_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../robot/actuator_step.h"
#include "step_comparison.h"
#include "support/support.h"

namespace musclesim {
namespace {

std::unique_ptr<Simulation> build(const std::string& robot, const std::vector<std::string>& parameters,
                                  PhysicsKind physics = PhysicsKind::si, StepperKind stepper = StepperKind::automatic) {
  SimulationOptions options;
  options.physics = physics;
  options.stepper = stepper;
  for (const auto& assignment : parameters) options.parameters.setFromText(assignment, "test");
  auto simulation = std::make_unique<Simulation>(std::move(options));
  simulation->build(robot);
  return simulation;
}

TEST(InternalStep, FollowsFromTensionAndBeads) {
  const auto normal = build("rig", {}), heavy = build("rig", {"muscle.bead_mass_g=40"});
  // Four times the mass (and inertia): half the rate of the sway, twice the step.
  EXPECT_NEAR(fastestSwayRadPerS(*normal->world().actuators().front()) / fastestSwayRadPerS(*heavy->world().actuators().front()), 2, 1e-9);
  const double longest_s = 0.45 * 2 / fastestSwayRadPerS(*normal->world().actuators().front());
  EXPECT_LE(normal->internalStepS(), longest_s);
  EXPECT_GT(normal->stepS() / (normal->substeps() - 1), longest_s);
}

TEST(InternalStep, SwayHasTheRateOfNeighbouringLinks) {
  // At full length and pressure: F = 96.1 N (Eq. 1), links of 300 mm / 8, beads 22.5 mm apart, I = 0.4 m r^2.
  const auto rig = build("rig", {});
  const double link = 300.0 / 8, d = link - 15;
  const double at_full_length = std::sqrt(96.1e6 * link / (10 * d * d / 2 + 2 * 0.4 * 10 * 7.5 * 7.5));
  EXPECT_GE(fastestSwayRadPerS(*rig->world().actuators().front()), at_full_length * (1 - 1e-3));
  EXPECT_LE(fastestSwayRadPerS(*rig->world().actuators().front()), 1.5 * at_full_length);
}

TEST(InternalStep, OriginalPhysicsHasOne) {
  EXPECT_EQ(build("arm", {}, PhysicsKind::original)->substeps(), 1);
}

TEST(InternalStep, ErrorReductionOfJointsFollowsTheStep) {
  const auto rig = build("rig", {}, PhysicsKind::si, StepperKind::ode);
  const double expected = 500 * rig->internalStepS();
  EXPECT_NEAR(dWorldGetERP(rig->world()), expected, 1e-12);
  EXPECT_NEAR(dJointGetBallParam(rig->world().actuators().front()->endJoint()->id(), dParamERP), expected, 1e-12);
}

TEST(InternalStep, StopsKeepTheirComplianceWhateverTheStep) {
  // ODE's spring and damper: k = ERP / (h CFM), d = (1 - ERP) / CFM.
  for (const char* longest : {"physics.longest_internal_step_s=1e-3", "physics.longest_internal_step_s=1e-4"}) {
    const auto rig = build("rig", {longest}, PhysicsKind::si, StepperKind::ode);
    const dJointID hinge = rig->world().actuators().front()->hinges().front()->id();
    const double erp = dJointGetHingeParam(hinge, dParamStopERP), cfm = dJointGetHingeParam(hinge, dParamStopCFM);
    const double stiffness_Nm_per_rad = erp / (rig->internalStepS() * cfm) / 1e9;
    EXPECT_NEAR(stiffness_Nm_per_rad, 1 / 0.03, 1e-6);
    EXPECT_NEAR((1 - erp) / cfm / 1e9, 0.002 / 0.03, 1e-6) << "N m s";
  }
}

/// The beads' additional inertia matters only while the chain turns: a short and a long step end at the same place.
TEST(InternalStep, AdditionalInertiaVanishesWithTheStep) {
  const auto rig = build("rig", {});
  const Actuator& muscle = *rig->world().actuators().front();
  rig->robot().step({1.0});
  const double increase = beadInertiaIncrease(muscle, 1e-3);
  EXPECT_NEAR(increase, 0.25 * 1e-6 * muscle.tensionN() * 1e6 * muscle.lengthMm() / (2 * 8), 1e-9 * increase);
  EXPECT_NEAR(beadInertiaIncrease(muscle, 1e-4), increase / 100, 1e-9 * increase);
}

/// Both steppers do every step from the same state.
double worstDifference(const std::string& robot, const std::vector<std::string>& parameters, PhysicsKind physics, int steps) {
  const auto ode = build(robot, parameters, physics, StepperKind::ode), chain = build(robot, parameters, physics, StepperKind::chain);
  RandomStream random(3, "test");
  Action command(static_cast<std::size_t>(ode->robot().actuatorCount()), 0.0);
  double worst = 0;
  for (int i = 0; i < steps; ++i) {
    if (i % 10 == 0)
      for (double& pressure : command) pressure = random.uniform();
    for (Simulation* simulation : {ode.get(), chain.get()}) simulation->robot().step(command);
    makeComparable(*ode, *chain);
    ode->advance(ode->internalStepS());
    chain->advance(chain->internalStepS());
    worst = std::max(worst, velocityDifference(*ode, *chain));
  }
  return worst;
}

TEST(ViscousFriction, BothSteppersAgree) {
  for (const PhysicsKind physics : {PhysicsKind::si, PhysicsKind::original}) {
    EXPECT_LT(worstDifference("rig", {"muscle.joint_friction=viscous"}, physics, 500), 1e-9);
    EXPECT_LT(worstDifference("elbow", {"muscle.joint_friction=viscous"}, physics, 300), 1e-9);
    EXPECT_LT(worstDifference("arm", {"muscle.joint_friction=viscous", "arm.muscle_count=5"}, physics, 100), 1e-9);
  }
}

TEST(LineMuscles, BothSteppersAgree) {
  for (const PhysicsKind physics : {PhysicsKind::si, PhysicsKind::original})
    EXPECT_LT(worstDifference("arm", {"muscle.model=line"}, physics, 500), 1e-9);
}

TEST(ViscousFriction, HasNoStiction) {
  // The load is a little below the muscle's tension: dry friction of 1 N per slider holds it, viscous friction lets it creep.
  double moved_mm[2];
  for (const bool viscous : {false, true}) {
    const auto rig = build("rig", {"rig.load_kg=2", viscous ? "muscle.joint_friction=viscous" : "muscle.joint_friction=coulomb"});
    rig->start("settled", {0.5});
    rig->advance(3);
    const double before = rig->world().actuators().front()->lengthMm();
    rig->robot().step({0.505});
    rig->advance(3);
    moved_mm[viscous] = std::abs(rig->world().actuators().front()->lengthMm() - before);
  }
  EXPECT_LT(moved_mm[0], 0.05);
  EXPECT_GT(moved_mm[1], 0.2);
}

}  // namespace
}  // namespace musclesim
