#include "musclesim/robot/robot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>

#include "musclesim/base/error.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/robot/robot_registry.h"
#include "musclesim/simulation/simulation.h"
#include "support/not_finite.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// Two muscles that carry one bar.
class Swing : public Robot {
 public:
  explicit Swing(World& world) : Robot(world) {
    auto* bar = new Box(world, space(), {0, -200, 0}, parameter("swing.bar_g", 500, "g", 1, 1e4, "mass of the bar"), 0, 120, 10, 10);
    addAngle("bar", bar->attachHinge(nullptr, {0, -200, 0}, Vector::UnitZ(), -30, 30));
    for (const double x : {-40.0, 40.0}) {
      auto* muscle = new Muscle(world, space(), {x, 0, 0}, {x, -60, 0}, {x, -120, 0}, {x, -190, 0}, 100, 250);
      muscle->connectStartTo(nullptr);
      muscle->connectEndTo(bar);
      addActuator(muscle);
    }
  }
};

std::vector<double> valuesOf(Simulation& simulation) {
  return simulation.robot().signalValues(simulation.robot().getState());
}

/// All signals after a short run of the elbow.
std::vector<double> shortRun(StepperKind stepper = StepperKind::automatic) {
  SimulationOptions options;
  options.step_s = 0.005;
  options.substeps = 4;
  options.stepper = stepper;
  Simulation simulation(options);
  simulation.build("elbow");
  simulation.start("built", {0.2, 0.7});
  for (int i = 0; i < 10; ++i) simulation.step();
  return valuesOf(simulation);
}

TEST(RobotRegistry, KnowsTheThreeRobotsAndAUsers) {
  registerRobot<Swing>("swing", "a bar on two muscles");
  std::vector<std::string> names;
  for (const auto& [name, description] : registeredRobots()) {
    names.push_back(name);
    EXPECT_FALSE(description.empty()) << name;
  }
  for (const char* name : {"arm", "elbow", "rig", "swing"}) EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  Simulation simulation;
  EXPECT_EQ(simulation.build("swing").name(), "swing");
  EXPECT_EQ(simulation.robot().actuatorCount(), 2);
}

TEST(RobotRegistry, AnUnknownRobotSuggestsTheNearest) {
  Simulation simulation;
  const auto message = messageOf<BadParameter>([&] { simulation.build("elbo"); });
  EXPECT_TRUE(contains(message, "there is no robot \"elbo\", did you mean \"elbow\"?"));
  EXPECT_TRUE(contains(message, "registered: arm, elbow, pulley_arm, rig"));
  EXPECT_THROW(simulation.build(""), BadParameter);
  EXPECT_NO_THROW(simulation.build("elbow")) << "the simulation can still take a robot";
}

TEST(Robot, OnePerSimulation) {
  Simulation simulation;
  EXPECT_THROW(simulation.robot(), BadParameter);
  simulation.build("rig");
  EXPECT_THROW(simulation.build("elbow"), BadParameter);
  EXPECT_THROW(simulation.build<Swing>(), BadParameter);
}

TEST(Robot, TheActiveRobotIsThatOfTheThreadsCurrentSimulation) {
  Simulation first, second;
  first.build("rig");
  second.build("elbow");
  EXPECT_EQ(Robot::getActiveRobot(), &second.robot());
  first.makeCurrent();
  EXPECT_EQ(Robot::getActiveRobot(), &first.robot());
  std::string message;
  std::thread([&] { message = messageOf<BadParameter>([] { Robot::getActiveRobot(); }); }).join();
  EXPECT_TRUE(contains(message, "no current simulation"));
}

TEST(Robot, SignalsComeInTheOrderOfARecording) {
  Simulation simulation;
  Robot& robot = simulation.build<Swing>();
  const std::vector<std::string> expected = {"command_0", "command_1",   "pressure_0",  "pressure_1",   "force_0_N",
                                             "force_1_N", "length_0_mm", "length_1_mm", "angle_bar_deg"};
  EXPECT_EQ(robot.signalNames(), expected);
  robot.step({0.25, 0.75});
  const State state = robot.getState();
  EXPECT_FALSE(state.hand_mm.has_value());
  const std::vector<double> values = robot.signalValues(state);
  ASSERT_EQ(values.size(), expected.size());
  EXPECT_EQ(values[1], 0.75);
  EXPECT_EQ(values[3], 0.75) << "pressures are those just after the command began to act";
  EXPECT_EQ(values[5], robot.actuators()[1]->calculateForce(0.75, values[7])) << "and so are forces";
  EXPECT_NEAR(values[6], 190, 1e-9);
  EXPECT_EQ(values[8], 0);
}

TEST(Robot, ItsParametersAreTakenFromOverridesAndChecked) {
  SimulationOptions options;
  options.parameters.setFromText("swing.bar_g=0", "--set");
  Simulation simulation(options);
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { simulation.build<Swing>(); }), "--set: swing.bar_g = 0 g"));
}

TEST(Robot, AnActionOfAnotherSizeIsRefused) {
  Simulation simulation;
  Robot& robot = simulation.build<Swing>();
  for (const Action& wrong : {Action{}, Action{0.5}, Action{0.5, 0.5, 0.5}}) EXPECT_THROW(robot.step(wrong), BadParameter);
  EXPECT_EQ(messageOf<BadParameter>([&] { robot.step({0.5}); }), "number of commanded pressures = 1: must be 2, one per muscle");
}

TEST(Robot, AnActionOutsideOfZeroToOneIsRefused) {
  Simulation simulation;
  Robot& robot = simulation.build<Swing>();
  for (const double wrong : {-0.01, 1.01, -1e300, 1e300}) {
    const auto message = messageOf<BadParameter>([&] { robot.step({0.5, wrong}); });
    EXPECT_TRUE(contains(message, "command of muscle_1"));
    EXPECT_TRUE(contains(message, "must lie in 0 .. 1"));
  }
}

TEST(Robot, AnActionThatIsNotFiniteEndsTheRun) {
  for (const double wrong : {nan, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    Simulation simulation;
    Robot& robot = simulation.build<Swing>();
    robot.step({0.5, 0.5});
    simulation.step();
    try {
      robot.step({0.5, wrong});
      FAIL() << "nothing was thrown for " << wrong;
    } catch (const Diverged& diverged) {
      EXPECT_EQ(diverged.where(), "command_1");
      EXPECT_NEAR(diverged.time_s(), 0.01, 1e-15);
    }
    EXPECT_EQ(robot.getState().command[0], 0.5) << "the commands before hold";
  }
}

TEST(Robot, ThatCannotSettleSaysSo) {
  class Loose : public Swing {
   public:
    explicit Loose(World& world) : Swing(world) { new Sphere(world, space(), {0, -400, 0}, 100, 0, 10); }
  };
  Simulation simulation;
  Robot& robot = simulation.build<Loose>();
  EXPECT_EQ(robot.initialState(), "built");
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { simulation.start("settled", {0, 0}); }), "use built"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { simulation.start("lying", {0, 0}); }), "initial_state = lying"));
}

TEST(Robot, SimulationsInOneProcessDoNotDisturbEachOther) {
  for (const StepperKind stepper : {StepperKind::automatic, StepperKind::ode, StepperKind::quick}) {
    const auto alone = shortRun(stepper);
    SimulationOptions options;
    options.step_s = 0.005;
    options.substeps = 4;
    options.stepper = stepper;
    Simulation first(options), second(options);
    for (auto* simulation : {&first, &second}) {
      simulation->build("elbow");
      simulation->start("built", {0.2, 0.7});
    }
    for (int i = 0; i < 10; ++i) {
      first.step();
      second.step();
    }
    EXPECT_EQ(valuesOf(first), alone);
    EXPECT_EQ(valuesOf(second), alone);
  }
}

TEST(Robot, SimulationsInSeveralThreadsGiveIdenticalBits) {
  for (const StepperKind stepper : {StepperKind::automatic, StepperKind::ode, StepperKind::quick}) {
    const auto alone = shortRun(stepper);
    for (int repeat = 0; repeat < 10; ++repeat) {
      auto one = std::async(std::launch::async, shortRun, stepper), other = std::async(std::launch::async, shortRun, stepper);
      EXPECT_EQ(shortRun(stepper), alone);
      EXPECT_EQ(one.get(), alone);
      EXPECT_EQ(other.get(), alone);
    }
  }
}

/// Swing, by named fields.
class NamedSwing : public Robot {
 public:
  explicit NamedSwing(World& world) : Robot(world) {
    Box& bar = addBox({.mass_g = 500, .center_mm = {0, -200, 0}, .size_mm = {120, 10, 10}, .name = "bar"});
    reportAngle("bar", bar.hingeToWorld({.axis = Vector::UnitZ(), .limits_deg = Limits{-30, 30}}));
    for (const double x : {-40.0, 40.0})
      addMuscle({.from = fixedAt({x, 0, 0}), .to = bar.at({x, -190, 0}), .length_mm = {100, 250}, .name = "lift"});
  }
};

TEST(RobotBuilder, MovesAsTheSameRobotBuiltByThePapersCalls) {
  class StraightSwing : public Robot {
   public:
    explicit StraightSwing(World& world) : Robot(world) {
      auto* bar = new Box(world, space(), {0, -200, 0}, 500, 0, 120, 10, 10);
      addAngle("bar", bar->attachHinge(nullptr, {0, -200, 0}, Vector::UnitZ(), -30, 30));
      for (const double x : {-40.0, 40.0}) {
        const Vector top(x, 0, 0), third = (Vector(x, -190, 0) - top) / 3;
        auto* muscle = new Muscle(world, space(), top, top + third, top + 2 * third, {x, -190, 0}, 100, 250);
        muscle->connectStartTo(nullptr);
        muscle->connectEndTo(bar);
        addActuator(muscle);
      }
    }
  };
  Simulation by_name, by_call;
  Robot &one = by_name.build<NamedSwing>(), &other = by_call.build<StraightSwing>();
  EXPECT_EQ(by_name.world().primitives().front()->name(), "bar");
  EXPECT_EQ(one.actuators()[1]->name(), "lift");
  for (int step = 0; step < 50; ++step) {
    one.step({0.7, 0.2});
    other.step({0.7, 0.2});
    by_name.step();
    by_call.step();
  }
  EXPECT_EQ(one.getState().angle_deg[0], other.getState().angle_deg[0]);
  EXPECT_EQ(one.getState().force_N, other.getState().force_N);
  EXPECT_NE(one.getState().angle_deg[0], 0);
}

TEST(RobotBuilder, RefusesWhatThePapersCallsRefuse) {
  class Massless : public Robot {
   public:
    explicit Massless(World& world) : Robot(world) { addSphere({.radius_mm = 5}); }
  };
  class Flat : public Robot {
   public:
    explicit Flat(World& world) : Robot(world) { addCapsule({.mass_g = 5, .radius_mm = 2}); }
  };
  EXPECT_THROW(Simulation().build<Massless>(), BadParameter);
  EXPECT_THROW(Simulation().build<Flat>(), BadParameter);
}

}  // namespace
}  // namespace musclesim
