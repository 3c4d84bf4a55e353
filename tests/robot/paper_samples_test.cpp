/// The calls of the paper's Sections 4.3 and 4.4, word for word: building a robot, and the loop that runs it.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "musclesim/controller/controller.h"
#include "musclesim/robot/linear_actuator.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {
namespace {

/// Section 4.3: primitives, their joints, composites, actuators.
class PaperRobot : public Robot {
 public:
  explicit PaperRobot(World& the_world) : Robot(the_world) {
    dWorldID world = this->world();
    dSpaceID space = this->space();

    Primitive* box = new Box(world, space, Vector(-100, 300, 0), 100, 0, 40, 20, 30);
    Primitive* sphere = new Sphere(world, space, Vector(0, 100, 0), 50, 0, 20);
    Primitive* cylinder = new CappedCylinder(world, space, Vector(0, 0, 0), 0, 0.001, 10, 160);
    box->setColor(0.8, 0.8, 0.8);
    cylinder->rotate(90, Vector(1, 0, 0));
    cylinder->compositeWithPrimitive(sphere);
    box->fix();

    Primitive* palm = new Box(world, space, Vector(0, -130, 0), 20, 0, 60, 40, 15);
    Primitive* thumb = new Box(world, space, Vector(-40, -130, 0), 5, 0, 10, 40, 10);
    Primitive* finger = new Box(world, space, Vector(0, -180, 0), 10, 0, 15, 60, 10);
    std::vector<Primitive*> parts = {thumb, finger, palm};
    Primitive::compositePrimitives(parts);

    cylinder->attachBall(box, Vector(0, 120, 0));
    hinge = palm->attachHinge(cylinder, Vector(0, -100, 0), Vector(1, 0, 0), -60, 60);

    Primitive* pendulum = new Sphere(world, space, Vector(300, 0, 0), 50, 0, 10);
    ball = pendulum->attachBall(NULL, Vector(300, 50, 0), Vector(1, 0, 0), Vector(0, 0, 1), {-30, 30}, {-30, 30}, {-30, 30});
    Primitive* wheel = new Sphere(world, space, Vector(400, 0, 0), 50, 0, 10);
    wheel->attachHinge(NULL, Vector(400, 50, 0), Vector(0, 0, 1));
    Primitive* hub = new Box(world, space, Vector(400, -60, 0), 50, 0, 10, 10, 10);
    hub->attachHinge(wheel, Vector(400, -30, 0), Vector(0, 1, 0), Vector(0, 0, 1));
    Primitive* rim = new Box(world, space, Vector(400, -120, 0), 50, 0, 10, 10, 10);
    rim->attachHinge(hub, Vector(400, -90, 0), Vector(0, 1, 0), Vector(0, 0, 1), {-10, 10}, {-20, 20});
    Primitive* cross = new Sphere(world, space, Vector(500, 0, 0), 50, 0, 10);
    cross->attachUniversal(NULL, Vector(500, 50, 0), Vector(1, 0, 0), Vector(0, 0, 1));
    Primitive* limited_cross = new Sphere(world, space, Vector(600, 0, 0), 50, 0, 10);
    limited_cross->attachUniversal(NULL, Vector(600, 50, 0), Vector(1, 0, 0), Vector(0, 0, 1), {-45, 45}, {-45, 45});
    Primitive* one_axis = new Sphere(world, space, Vector(700, 0, 0), 50, 0, 10);
    one_axis->attachUniversal(NULL, Vector(700, 50, 0), Vector(0, 0, 1));
    Primitive* limited_one_axis = new Sphere(world, space, Vector(800, 0, 0), 50, 0, 10);
    limited_one_axis->attachUniversal(NULL, Vector(800, 50, 0), Vector(0, 0, 1), -45, 45);

    Muscle* muscle =
        new Muscle(world, space, Vector(-100, 300, 0), Vector(-80, 200, 20), Vector(-60, 50, 20), Vector(-10, -20, 0), 150, 400);
    muscle->connectStartTo(box);
    muscle->connectEndTo(cylinder);
    muscle->setColor(1, 0, 0);
    addActuator(muscle);

    LinearActuator* actuator = new LinearActuator(world, space, Vector(-60, 280, 0), Vector(-8, 60, 0), 150, 300);
    actuator->connectStartTo(box);
    actuator->connectEndTo(cylinder);
    addActuator(actuator);

    addAngle("wrist", hinge);
    setHand(palm);
  }

  Joint* hinge;
  Joint* ball;
};

/// Section 4.4: a controller computes an action from a state.
class PaperController : public Controller {
 public:
  Action output(const State& state) override {
    ++calls;
    Action action(state.length_mm.size());
    for (std::size_t i = 0; i < action.size(); ++i) action[i] = 0.5 + 0.5 * std::sin(10 * state.time_s + static_cast<double>(i));
    return action;
  }
  int calls = 0;
};

TEST(PaperSamples, BuildAndRunAsPrinted) {
  SimulationOptions options;
  options.substeps = 5;
  Simulation simulation(options);
  simulation.build<PaperRobot>();
  simulation.control(std::make_unique<PaperController>());

  // Section 4.4, the run loop.
  Robot* robot = Robot::getActiveRobot();
  Controller* controller = Controller::getActiveController();
  const State first = robot->getState();
  for (int i = 0; i < 50; ++i) {
    State state = robot->getState();
    Action action = controller->output(state);
    robot->step(action);
    Simulation::doStep();
  }

  const State last = robot->getState();
  EXPECT_NEAR(last.time_s, 0.5, 1e-12);
  EXPECT_EQ(static_cast<PaperController*>(controller)->calls, 50);
  EXPECT_GT((*last.hand_mm - *first.hand_mm).norm(), 5) << "the robot moved";
  EXPECT_LT(std::abs(last.angle_deg[0]), 61);
}

TEST(PaperSamples, TheSpringActuatorOfAUser) {
  // A derived class that overrides calculateForce makes another actuator.
  class Spring : public LinearActuator {
   public:
    using LinearActuator::LinearActuator;
    double calculateForce(double, double length_mm) const override { return 0.1 * (length_mm - 100); }
  };
  Simulation simulation;
  auto* spring = new Spring(simulation.world(), simulation.space(), Vector(0, 0, 0), Vector(0, -150, 0), 50, 300);
  spring->connectStartTo(NULL);
  spring->connectEndTo(NULL);
  Simulation::doStep();
  EXPECT_NEAR(spring->tensionN(), 5, 1e-3);
}

}  // namespace
}  // namespace musclesim
