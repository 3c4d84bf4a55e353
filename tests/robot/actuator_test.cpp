#include "musclesim/robot/actuator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/linear_actuator.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/simulation/simulation.h"
#include "support/not_finite.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// A user's actuator: one link that pulls with a constant force at full pressure.
class Winch : public Actuator {
 public:
  Winch(Simulation& simulation, double length_mm)
      : Actuator(simulation.world(), simulation.space(), {Vector(0, 0, 0), Vector(0, -length_mm, 0)}, 20, 20, 500) {}
  double calculateForce(double pressure_ratio, double) const override { return full_N * pressure_ratio; }
  double full_N = 30;
};

/// A user's actuator and a user's bone whose constructors throw.
class BrokenWinch : public Winch {
 public:
  explicit BrokenWinch(Simulation& simulation) : Winch(simulation, 100) { throw BadParameter("the winch is broken"); }
};
class BrokenBone : public Sphere {
 public:
  explicit BrokenBone(Simulation& simulation) : Sphere(simulation.world(), simulation.space(), {0, 0, 0}, 1, 0, 10) {
    throw BadParameter("the bone is broken");
  }
};

Muscle* hangingMuscle(Simulation& simulation) {
  return new Muscle(simulation.world(), simulation.space(), {0, 0, 0}, {0, -70, 0}, {0, -140, 0}, {0, -210, 0}, 120, 300);
}

TEST(Actuator, ThatThrowsWhileItIsBuiltIsForgotten) {
  Simulation simulation;
  EXPECT_THROW(new BrokenWinch(simulation), BadParameter);
  EXPECT_THROW(new BrokenBone(simulation), BadParameter);
  EXPECT_TRUE(simulation.world().actuators().empty());
  EXPECT_TRUE(simulation.world().primitives().empty());
}

TEST(Actuator, ItsEndsAreConnectedOnce) {
  Simulation simulation;
  auto* muscle = hangingMuscle(simulation);
  auto* load = new Sphere(simulation.world(), nullptr, {0, -210, 0}, 500, 0, 10);
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(load);
  EXPECT_EQ(messageOf<BadParameter>([&] { muscle->connectStartTo(load); }), "the start of muscle_0 is already connected");
  EXPECT_EQ(messageOf<BadParameter>([&] { muscle->connectEndTo(nullptr); }), "the end of muscle_0 is already connected");
  EXPECT_EQ(muscle->startJoint()->name(), "start of muscle_0");
  EXPECT_EQ(dJointGetBody(muscle->endJoint()->id(), 1), load->body().id);
}

TEST(Actuator, IsNotConnectedToAnotherSimulation) {
  Simulation simulation, other;
  auto* muscle = hangingMuscle(simulation);
  auto* stranger = new Sphere(other.world(), nullptr, {0, 0, 0}, 500, 0, 10);
  EXPECT_THROW(muscle->connectStartTo(stranger), BadParameter);
  EXPECT_THROW(muscle->connectEndTo(stranger), BadParameter);
  EXPECT_EQ(muscle->startJoint(), nullptr);
}

TEST(Actuator, MayHaveUnconnectedEnds) {
  Simulation simulation;
  auto* muscle = hangingMuscle(simulation);
  muscle->setPressure(0.5);
  for (int i = 0; i < 10; ++i) simulation.step();
  EXPECT_EQ(muscle->startJoint(), nullptr);
  EXPECT_EQ(muscle->endJoint(), nullptr);
  EXPECT_LT(muscle->tensionN(), 1) << "nothing holds it: it contracts until the friction of its sliders, 1 N, stops it";
  EXPECT_LT(dBodyGetPosition(muscle->links()[0].bead[0])[1], -45 - 7.5) << "and falls";
}

TEST(Actuator, AUsersForceReplacesTheForceLaw) {
  Simulation simulation;
  auto* winch = new Winch(simulation, 200);
  auto* load = new Sphere(simulation.world(), nullptr, {0, -200, 0}, 1000, 0, 10);
  winch->connectStartTo(nullptr);
  winch->connectEndTo(load);
  winch->setPressure(0.5);
  simulation.advance(0.1);
  EXPECT_EQ(winch->tensionN(), 15);
  // 1010 g are pulled up with 15 N against 1 N of friction.
  const double acceleration = (14 / 1.01 - 9.81) * mm_per_m;
  EXPECT_NEAR(load->getPosition().y(), -200 + acceleration * 0.01 / 2, 0.3);
}

TEST(Actuator, TakesAForceLawOfItsOwn) {
  struct Constant : ForceLaw {
    double tensionN(double p, double) const override { return 7 * p; }
    std::string name() const override { return "constant"; }
  };
  Simulation simulation;
  auto* muscle = hangingMuscle(simulation);
  muscle->setForceLaw(std::make_unique<Constant>());
  EXPECT_EQ(muscle->calculateForce(0.5, 200), 3.5);
  EXPECT_EQ(muscle->forceLaw().name(), "constant");
  EXPECT_THROW(muscle->setForceLaw(nullptr), BadParameter);
}

TEST(Actuator, AForceThatIsNotFiniteStopsTheRunAndNamesTheMuscle) {
  for (const double wrong : {nan, inf, -inf}) {
    Simulation simulation;
    auto* winch = new Winch(simulation, 200);
    winch->setName("winch of the crane");
    winch->connectStartTo(nullptr);
    winch->setPressure(1);
    simulation.step();
    winch->full_N = wrong;
    try {
      simulation.step();
      FAIL() << "nothing was thrown for " << wrong;
    } catch (const Diverged& diverged) {
      EXPECT_EQ(diverged.where(), "winch of the crane");
      EXPECT_NEAR(diverged.time_s(), 0.01, 1e-12);
      EXPECT_TRUE(contains(diverged.what(), "its tension is"));
    }
  }
}

TEST(Actuator, PressuresOutsideOfZeroToOneAreRefused) {
  Simulation simulation;
  auto* muscle = hangingMuscle(simulation);
  for (const double wrong : {-0.001, 1.001, nan, inf, -inf}) EXPECT_THROW(muscle->setPressure(wrong), BadParameter) << wrong;
  EXPECT_EQ(messageOf<BadParameter>([&] { muscle->setPressure(1.5); }), "command of muscle_0 = 1.5: must lie in 0 .. 1");
  EXPECT_NO_THROW(muscle->setPressure(0));
  EXPECT_NO_THROW(muscle->setPressure(1));
}

TEST(Actuator, WithoutEffectsThePressureIsTheCommand) {
  Simulation simulation;
  auto* muscle = hangingMuscle(simulation);
  muscle->setPressure(0.3);
  EXPECT_EQ(muscle->command(), 0.3);
  EXPECT_EQ(muscle->pressure(), 0) << "until a step is made";
  simulation.step();
  EXPECT_EQ(muscle->pressure(), 0.3);
}

TEST(Actuator, TensionPullsBothEndsAlike) {
  Simulation simulation;
  dWorldSetGravity(simulation.world(), 0, 0, 0);
  auto* muscle = hangingMuscle(simulation);
  auto* above = new Sphere(simulation.world(), nullptr, {0, 0, 0}, 500, 0, 10);
  auto* below = new Sphere(simulation.world(), nullptr, {0, -210, 0}, 500, 0, 10);
  muscle->connectStartTo(above);
  muscle->connectEndTo(below);
  muscle->setPressure(0.5);
  for (int i = 0; i < 5; ++i) simulation.step();
  EXPECT_LT(above->getPosition().y(), -1);
  EXPECT_NEAR(above->getPosition().y() + below->getPosition().y(), -210, 1e-6);
}

TEST(Actuator, NumbersOfTheChainAreParameters) {
  SimulationOptions options;
  options.parameters.set("muscle.bead_mass_g", 4.0, "test");
  options.parameters.set("muscle.bead_radius_mm", 5.0, "test");
  options.parameters.set("muscle.slider_friction_N", 0.0, "test");
  Simulation simulation(options);
  auto* muscle = hangingMuscle(simulation);
  EXPECT_EQ(muscle->links().size(), 12u);
  EXPECT_EQ(muscle->massG(), 96);
  EXPECT_EQ(dJointGetSliderParam(muscle->links()[0].slider->id(), dParamFMax), 0);
  SimulationOptions wrong;
  wrong.parameters.set("muscle.bead_mass_g", 0.0, "test");
  Simulation refused(wrong);
  EXPECT_THROW(hangingMuscle(refused), BadParameter);
}

TEST(Actuator, AreOwnedByTheSimulationAndNumbered) {
  Simulation simulation;
  auto *first = hangingMuscle(simulation),
       *second = new Muscle(simulation.world(), simulation.space(), {50, 0, 0}, {50, -70, 0}, {50, -140, 0}, {50, -210, 0}, 120, 300);
  ASSERT_EQ(simulation.world().actuators().size(), 2u);
  EXPECT_EQ(simulation.world().actuators()[1], second);
  EXPECT_EQ(first->name(), "muscle_0");
  EXPECT_EQ(second->name(), "muscle_1");
  second->setColor(1, 0.5, 0, "orange");
  EXPECT_EQ(second->color().name, "orange");
  EXPECT_EQ(second->color().green, 0.5);
}

}  // namespace
}  // namespace musclesim
