#include <gtest/gtest.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

SimulationOptions rigOptions(const std::vector<std::pair<std::string, double>>& parameters) {
  SimulationOptions options;
  options.substeps = 5;
  for (const auto& [name, value] : parameters) options.parameters.set(name, value, "test");
  return options;
}

TEST(Rig, HasOneMuscleAndNoJointAngles) {
  Simulation simulation;
  Robot& robot = simulation.build("rig");
  EXPECT_EQ(robot.signalNames(), (std::vector<std::string>{"command_0", "pressure_0", "force_0_N", "length_0_mm"}));
  EXPECT_EQ(robot.initialState(), "settled");
  EXPECT_EQ(robot.actuators()[0]->minimumLengthMm(), 120);
  EXPECT_EQ(robot.actuators()[0]->maximumLengthMm(), 300);
  EXPECT_EQ(robot.actuators()[0]->links().size(), 8u);
  ASSERT_EQ(simulation.world().primitives().size(), 1u);
  EXPECT_EQ(simulation.world().primitives()[0]->massG(), 2000);
}

TEST(Rig, ItsNumbersAreParameters) {
  Simulation simulation(rigOptions({{"rig.load_kg", 0.5}, {"rig.minimum_length_mm", 90}, {"rig.maximum_length_mm", 200}}));
  Robot& robot = simulation.build("rig");
  EXPECT_EQ(simulation.world().primitives()[0]->massG(), 500);
  EXPECT_EQ(robot.actuators()[0]->links().size(), 6u);
  EXPECT_NEAR(robot.getState().length_mm[0], 145, 1e-9) << "built half way between";
}

TEST(Rig, ParametersOutOfRangeAreRefused) {
  for (const auto& wrong : {std::pair{"rig.load_kg", 0.0},
                            {"rig.load_kg", -2.0},
                            {"rig.minimum_length_mm", 14.0},
                            {"rig.maximum_length_mm", 100.0},
                            {"rig.maximum_length_mm", 1e9}}) {
    Simulation simulation(rigOptions({{wrong.first, wrong.second}}));
    EXPECT_THROW(simulation.build("rig"), BadParameter) << wrong.first << " = " << wrong.second;
  }
  Simulation simulation(rigOptions({{"rig.load_kg", -2.0}}));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { simulation.build("rig"); }), "rig.load_kg = -2 kg: must"));
}

TEST(Rig, SettlesWhereTheForceCarriesTheLoadAndHalfTheChain) {
  for (const double pressure : {0.3, 0.6, 0.9}) {
    Simulation simulation(rigOptions({}));
    Robot& robot = simulation.build("rig");
    simulation.settle({pressure});
    const State state = robot.getState();
    EXPECT_NEAR(state.force_N[0], (2.0 + 0.08) * 9.81, 1e-9);
    EXPECT_EQ(state.pressure[0], pressure);
    EXPECT_NEAR(simulation.world().primitives()[0]->getPosition().y(), -state.length_mm[0], 1e-9);
  }
}

TEST(Rig, StaysWhereItSettled) {
  Simulation simulation(rigOptions({}));
  Robot& robot = simulation.build("rig");
  simulation.settle({0.5});
  const double length_mm = robot.getState().length_mm[0];
  simulation.start("settled", {0.5});
  EXPECT_EQ(simulation.time_s(), 0);
  EXPECT_EQ(simulation.stepCount(), 0);
  EXPECT_NEAR(robot.getState().length_mm[0], length_mm, 0.01);
  simulation.advance(0.1);
  EXPECT_NEAR(robot.getState().length_mm[0], length_mm, 0.01);
}

TEST(Rig, SettlesAlikeInAllPhysics) {
  std::vector<double> lengths_mm;
  for (const PhysicsKind kind : {PhysicsKind::si, PhysicsKind::original, PhysicsKind::scaled}) {
    SimulationOptions options;
    options.physics = kind;
    Simulation simulation(options);
    Robot& robot = simulation.build("rig");
    simulation.settle({0.5});
    lengths_mm.push_back(robot.getState().length_mm[0]);
  }
  EXPECT_NEAR(lengths_mm[1], lengths_mm[0], 1e-9);
  EXPECT_NEAR(lengths_mm[2], lengths_mm[0], 1e-9);
}

TEST(Rig, SettlesAtTheStopsWhereTheLoadIsTooLightOrTooHeavy) {
  Simulation heavy(rigOptions({{"rig.load_kg", 20}}));
  heavy.build("rig");
  heavy.settle({0.5});
  EXPECT_NEAR(heavy.robot().getState().length_mm[0], 300, 1e-9);
  Simulation light(rigOptions({{"rig.load_kg", 1e-4}, {"muscle.bead_mass_g", 1e-3}}));
  light.build("rig");
  light.settle({1});
  EXPECT_NEAR(light.robot().getState().length_mm[0], 120, 0.01);
}

TEST(Rig, TheLoadMovesVerticallyOnly) {
  Simulation simulation(rigOptions({}));
  Robot& robot = simulation.build("rig");
  simulation.start("settled", {0.2});
  robot.step({0.9});
  for (int i = 0; i < 20; ++i) {
    dBodyAddForce(simulation.world().primitives()[0]->body().id, 1e6, 0, 1e6);
    simulation.step();
  }
  const Vector load = simulation.world().primitives()[0]->getPosition();
  EXPECT_NEAR(load.x(), 0, 1e-3);
  EXPECT_NEAR(load.z(), 0, 1e-3);
  EXPECT_GT(load.y(), -240);
}

TEST(Rig, StartsWithWrongCommandsAreRefused) {
  Simulation simulation;
  simulation.build("rig");
  EXPECT_THROW(simulation.start("settled", {}), BadParameter);
  EXPECT_THROW(simulation.start("settled", {1.5}), BadParameter);
}

}  // namespace
}  // namespace musclesim
