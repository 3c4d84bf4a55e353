#include "../../robot/springs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../../robot/ode_vector.h"
#include "../../simulation/snapshot.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// A bar of 400 g and 200 mm about its end, without gravity, or a carriage of 1 kg on a rail along x.
class Machine : public Robot {
 public:
  explicit Machine(World& world) : Robot(world) {
    bar = &addBox({.mass_g = 400, .center_mm = {100, 0, 0}, .size_mm = {200, 20, 20}});
    hinge = &bar->hingeToWorld({.anchor_mm = Vector(0, 0, 0)});
    reportAngle("bar", *hinge);
    carriage = &addBox({.mass_g = 1000, .center_mm = {0, 500, 0}, .size_mm = {20, 20, 20}});
    rail = carriage->attachSlider(nullptr, Vector::UnitX());
  }
  Box *bar, *carriage;
  Joint *hinge, *rail;
  static constexpr double bar_kgm2 = 0.4 * (0.2 * 0.2 + 0.02 * 0.02) / 12 + 0.4 * 0.1 * 0.1;
};

struct Bench {
  explicit Bench(PhysicsKind physics = PhysicsKind::si, StepperKind stepper = StepperKind::automatic)
      : simulation(optionsWith(physics, stepper)), machine(simulation.build<Machine>()) {}
  static SimulationOptions optionsWith(PhysicsKind physics, StepperKind stepper) {
    SimulationOptions options;
    options.physics = physics;
    options.stepper = stepper;
    options.step_s = 0.001;
    options.parameters.setFromText("physics.gravity_m_per_s2=0", "test");
    return options;
  }
  void turnBar(double rad_per_s) {
    dBodySetAngularVel(machine.bar->body().id, 0, 0, rad_per_s);
    dBodySetLinearVel(machine.bar->body().id, 0, rad_per_s * 100, 0);
  }
  void run(double duration_s) { simulation.advance(duration_s); }
  double barRadPerS() const { return dBodyGetAngularVel(machine.bar->body().id)[2]; }
  double carriageMmPerS() const { return dBodyGetLinearVel(machine.carriage->body().id)[0]; }
  Simulation simulation;
  Machine& machine;
};

class JointMechanicsTest : public testing::TestWithParam<StepperKind> {
 protected:
  Bench bench{PhysicsKind::si, GetParam()};
};

TEST_P(JointMechanicsTest, DryFrictionBrakesEvenlyAndHolds) {
  addJointMechanics(bench.simulation.world(), *bench.machine.hinge, {.friction = 0.01});
  bench.turnBar(2);
  bench.run(0.5);
  EXPECT_NEAR(bench.barRadPerS(), 2 - 0.01 / Machine::bar_kgm2 * 0.5, 2e-3);
  bench.run(1);
  const double rested_deg = bench.machine.hinge->angleDeg();
  EXPECT_NEAR(rested_deg, 4 / (2 * 0.01 / Machine::bar_kgm2) * deg_per_rad, 0.1);
  bench.run(0.5);
  EXPECT_NEAR(bench.machine.hinge->angleDeg(), rested_deg, 1e-4);
}

TEST_P(JointMechanicsTest, DampingSlowsExponentially) {
  addJointMechanics(bench.simulation.world(), *bench.machine.hinge, {.damping = 0.01});
  bench.turnBar(2);
  bench.run(0.5);
  EXPECT_NEAR(bench.barRadPerS(), 2 * std::exp(-0.01 / Machine::bar_kgm2 * 0.5), 2e-3);
}

TEST_P(JointMechanicsTest, StrongDampingDoesNotMakeAStepUnstable) {
  addJointMechanics(bench.simulation.world(), *bench.machine.hinge, {.damping = 1e3});
  bench.turnBar(2);
  bench.run(0.1);
  EXPECT_LT(std::abs(bench.barRadPerS()), 1e-3);
}

/// I dv/dt = -F - d v
TEST_P(JointMechanicsTest, DryFrictionThatComesLaterActsBesideTheDamping) {
  addJointMechanics(bench.simulation.world(), *bench.machine.hinge, {.damping = 0.01});
  bench.machine.hinge->addDryFriction(0.01 * mm_per_m * bench.simulation.physics().force_per_N);
  bench.turnBar(2);
  bench.run(0.2);
  EXPECT_NEAR(bench.barRadPerS(), 3 * std::exp(-0.01 / Machine::bar_kgm2 * 0.2) - 1, 2e-3);
  bench.run(1);
  EXPECT_NEAR(bench.barRadPerS(), 0, 1e-5);
}

/// A robot in C++ may use ODE's motor itself.
TEST_P(JointMechanicsTest, DryFrictionAddsToThatOfODEsMotor) {
  const double largest = 0.01 * mm_per_m * bench.simulation.physics().force_per_N;
  dJointSetHingeParam(bench.machine.hinge->id(), dParamFMax, largest);
  bench.machine.hinge->addDryFriction(largest);
  bench.turnBar(2);
  bench.run(0.25);
  EXPECT_NEAR(bench.barRadPerS(), 2 - 0.02 / Machine::bar_kgm2 * 0.25, 2e-3);
}

TEST_P(JointMechanicsTest, DampedJointReachesItsStopAndLeavesIt) {
  dJointSetHingeParam(bench.machine.hinge->id(), dParamLoStop, -1);
  dJointSetHingeParam(bench.machine.hinge->id(), dParamHiStop, 0.1);
  addJointMechanics(bench.simulation.world(), *bench.machine.hinge, {.damping = 0.01, .stiffness = 0.05});
  bench.turnBar(2);
  bench.run(0.06);
  EXPECT_NEAR(bench.machine.hinge->angleDeg(), 0.1 * deg_per_rad, 0.2);
  bench.run(0.5);
  EXPECT_LT(bench.machine.hinge->angleDeg(), 2);
}

TEST_P(JointMechanicsTest, SliderHasFrictionDampingAndSpring) {
  addJointMechanics(bench.simulation.world(), *bench.machine.rail, {.friction = 2});
  dBodySetLinearVel(bench.machine.carriage->body().id, 1000, 0, 0);
  bench.run(0.25);
  EXPECT_NEAR(bench.carriageMmPerS(), 500, 3);
  bench.run(0.5);
  EXPECT_NEAR(bench.carriageMmPerS(), 0, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Steppers, JointMechanicsTest, testing::Values(StepperKind::chain, StepperKind::ode));

TEST(JointSpring, SwingsWithItsPeriodAboutItsRest) {
  Bench bench;
  addJointMechanics(bench.simulation.world(), *bench.machine.hinge, {.stiffness = 0.5, .rest = 20});
  const double half_period_s = std::numbers::pi * std::sqrt(Machine::bar_kgm2 / 0.5);
  bench.run(half_period_s);
  EXPECT_NEAR(bench.machine.hinge->angleDeg(), 40, 0.1);
  bench.run(half_period_s);
  EXPECT_NEAR(bench.machine.hinge->angleDeg(), 0, 0.1);
}

TEST(JointSpring, IsTheSameInOriginalUnitsButSlower) {
  Bench bench(PhysicsKind::original);
  addJointMechanics(bench.simulation.world(), *bench.machine.hinge, {.stiffness = 0.5, .rest = 20});
  bench.run(std::numbers::pi * std::sqrt(Machine::bar_kgm2 / 0.5) * std::sqrt(1000.0));
  EXPECT_NEAR(bench.machine.hinge->angleDeg(), 40, 0.1);
}

TEST(JointMechanics, RefusesNegativeValues) {
  Bench bench;
  EXPECT_THROW(addJointMechanics(bench.simulation.world(), *bench.machine.hinge, {.friction = -1}), BadParameter);
  EXPECT_THROW(addJointMechanics(bench.simulation.world(), *bench.machine.hinge, {.damping = -1}), BadParameter);
  EXPECT_THROW(addJointMechanics(bench.simulation.world(), *bench.machine.hinge, {.stiffness = std::nan("")}), BadParameter);
}

std::unique_ptr<PointSpring> springTo(Bench& bench, const PointSpringSettings& settings) {
  return std::make_unique<PointSpring>(bench.simulation.world(), Attachment{nullptr, {300, 500, 0}},
                                       Attachment{bench.machine.carriage, {0, 500, 0}}, settings);
}

TEST(PointSpring, PullsTheCarriageToItsRestLengthAndBack) {
  Bench bench;
  bench.simulation.world().addForceElement(springTo(bench, {.stiffness_N_per_mm = 0.5, .rest_mm = 250}));
  bench.run(std::numbers::pi * std::sqrt(1 / 500.0));
  EXPECT_NEAR(bench.machine.carriage->getPosition().x(), 100, 0.1);
}

TEST(PointSpring, DampingTakesEnergyAway) {
  Bench bench;
  bench.simulation.world().addForceElement(springTo(bench, {.stiffness_N_per_mm = 0.5, .rest_mm = 250, .damping_Ns_per_m = 2}));
  const double decay_per_s = 2 / 2.0, rate = std::sqrt(500 - decay_per_s * decay_per_s), half_period_s = std::numbers::pi / rate;
  bench.run(half_period_s);
  EXPECT_NEAR(bench.machine.carriage->getPosition().x(), 50 * (1 + std::exp(-decay_per_s * half_period_s)), 0.2);
}

TEST(PointSpring, ARopeDoesNotPush) {
  Bench bench;
  bench.simulation.world().addForceElement(springTo(bench, {.stiffness_N_per_mm = 0.5, .rest_mm = 350, .pulls_only = true}));
  bench.run(0.2);
  EXPECT_NEAR(bench.machine.carriage->getPosition().x(), 0, 1e-9);
}

TEST(PointSpring, IsDrawnFromEndToEndAsACoilAndARopeAsALine) {
  Bench bench;
  bench.simulation.world().addForceElement(springTo(bench, {.stiffness_N_per_mm = 0.5, .rest_mm = 250}));
  bench.simulation.world().addForceElement(springTo(bench, {.stiffness_N_per_mm = 0.5, .rest_mm = 250, .pulls_only = true}));
  const Snapshot snapshot = SnapshotTaker(bench.simulation).take(bench.simulation.robot().truth());
  ASSERT_EQ(snapshot.springs.size(), 2u);
  const Eigen::Vector3f from(300, 500, 0), to(0, 500, 0);
  for (const DrawnSpring& spring : snapshot.springs) {
    EXPECT_LT((spring.points_mm.front() - from).norm(), 1e-3);
    EXPECT_LT((spring.points_mm.back() - to).norm(), 1e-3);
  }
  EXPECT_EQ(snapshot.springs[1].points_mm.size(), 2u);
  EXPECT_GT(snapshot.springs[0].points_mm.size(), 50u);
  for (const Eigen::Vector3f& point : snapshot.springs[0].points_mm) EXPECT_LT((point - Eigen::Vector3f(point.x(), 500, 0)).norm(), 7);
  EXPECT_GT(boundsOf(snapshot).high.x(), 300) << "the picture holds the end in the environment";
}

TEST(PointSpring, StaysInPlaceWhenTheCentreOfMassMoves) {
  Bench bench;
  auto spring = springTo(bench, {.stiffness_N_per_mm = 0.5, .rest_mm = 250});
  const PointSpring& kept = *spring;
  bench.simulation.world().addForceElement(std::move(spring));
  const auto forceOn = [&] {
    Vector sum = Vector::Zero();
    kept.load(true, [&](dBodyID, const BodyLoad& load) { sum += load.force_N; });
    return sum;
  };
  const Vector before = forceOn();
  EXPECT_NEAR(before.x(), 25, 1e-9);
  bench.machine.carriage->addPointMass(1000, {8, 505, 0});
  EXPECT_LT((forceOn() - before).norm(), 1e-9);
}

TEST(Wall, ThrowsTheCarriageBack) {
  Bench bench;
  bench.simulation.world().addForceElement(std::make_unique<Wall>(bench.simulation.world(), Attachment{bench.machine.carriage, {0, 500, 0}},
                                                                  Vector(50, 0, 0), Vector(-1, 0, 0), 10.0));
  dBodySetLinearVel(bench.machine.carriage->body().id, 1000, 0, 0);
  const double deepest_mm = 1000 * std::sqrt(1 / 10000.0);
  bench.run(0.05 + std::numbers::pi / 2 * std::sqrt(1 / 10000.0));
  EXPECT_NEAR(bench.machine.carriage->getPosition().x(), 50 + deepest_mm, 0.5);
  bench.run(0.2);
  EXPECT_NEAR(bench.carriageMmPerS(), -1000, 10);
}

TEST(Wall, RefusesANormalWithoutDirectionAndASoftWall) {
  Bench bench;
  const Attachment point{bench.machine.carriage, {0, 500, 0}};
  EXPECT_THROW(Wall(bench.simulation.world(), point, {50, 0, 0}, {0, 0, 0}, 1), BadParameter);
  EXPECT_THROW(Wall(bench.simulation.world(), point, {50, 0, 0}, {1, 0, 0}, 0), BadParameter);
}

}  // namespace
}  // namespace musclesim
