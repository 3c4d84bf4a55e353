#include <gtest/gtest.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

SimulationOptions withParameters(const std::vector<std::pair<std::string, double>>& parameters) {
  SimulationOptions options;
  options.substeps = 5;
  for (const auto& [name, value] : parameters) options.parameters.set(name, value, "test");
  return options;
}

TEST(Elbow, ReportsTwoMusclesOneAngleAndTheHand) {
  Simulation simulation;
  Robot& robot = simulation.build("elbow");
  EXPECT_EQ(robot.signalNames(),
            (std::vector<std::string>{"command_0", "command_1", "pressure_0", "pressure_1", "force_0_N", "force_1_N", "length_0_mm",
                                      "length_1_mm", "angle_elbow_deg", "hand_x_mm", "hand_y_mm", "hand_z_mm"}));
  EXPECT_EQ(robot.initialState(), "settled");
  const State state = robot.getState();
  EXPECT_EQ(state.angle_deg[0], 0);
  EXPECT_LT((*state.hand_mm - Vector(0, -250, 0)).norm(), 1e-9);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(state.length_mm[i], 260, 1e-9);
    EXPECT_EQ(robot.actuators()[i]->minimumLengthMm(), 150);
    EXPECT_EQ(robot.actuators()[i]->maximumLengthMm(), 320);
  }
}

TEST(Elbow, TheForearmHasItsMassAndItsInertiaAboutTheHinge) {
  Simulation simulation;
  simulation.build("elbow");
  const Primitive& forearm = *simulation.world().primitives()[0];
  dMass mass;
  dBodyGetMass(forearm.body().id, &mass);
  EXPECT_NEAR(mass.mass, 600, 1e-9);
  EXPECT_LT((forearm.getPosition() - Vector(0, -120, 0)).norm(), 1e-9);
  EXPECT_NEAR((mass.I[0] + mass.mass * 120 * 120) / g_mm2_per_kg_m2, 0.0125, 1e-12);
}

TEST(Elbow, TheFlexorMovesTheHandTowardsPlusX) {
  Simulation simulation(withParameters({}));
  Robot& robot = simulation.build("elbow");
  simulation.settle({0.8, 0.2});
  const State state = robot.getState();
  EXPECT_GT(state.angle_deg[0], 5);
  const double angle_rad = state.angle_deg[0] * rad_per_deg;
  EXPECT_LT((*state.hand_mm - 250 * Vector(std::sin(angle_rad), -std::cos(angle_rad), 0)).norm(), 1e-6);
  EXPECT_LT(state.length_mm[0], state.length_mm[1]);
}

TEST(Elbow, EqualPressuresSettleInTheMiddleAndExchangedOnesInTheMirror) {
  Simulation simulation(withParameters({}));
  Robot& robot = simulation.build("elbow");
  simulation.settle({0.5, 0.5});
  EXPECT_NEAR(robot.getState().angle_deg[0], 0, 1e-9);
  simulation.settle({0.5, 0.4});
  const double one_deg = robot.getState().angle_deg[0];
  simulation.settle({0.4, 0.5});
  EXPECT_NEAR(robot.getState().angle_deg[0], -one_deg, 1e-9);
}

TEST(Elbow, SettlesWhereTheTorquesBalance) {
  Simulation simulation(withParameters({}));
  Robot& robot = simulation.build("elbow");
  simulation.settle({0.5, 0.4});
  const State state = robot.getState();
  const double q = state.angle_deg[0] * rad_per_deg;
  double torque_Nmm = -0.6 * 9.81 * 120 * std::sin(q);
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? 1 : -1;
    const double x = side * 35 * std::cos(q) + 20 * std::sin(q), y = side * 35 * std::sin(q) - 20 * std::cos(q);
    const double to_x = side * 35 - x, to_y = 240 - y, length_mm = std::hypot(to_x, to_y);
    EXPECT_NEAR(state.length_mm[i], length_mm, 1e-6);
    torque_Nmm += state.force_N[i] * (x * to_y - y * to_x) / length_mm - x * robot.actuators()[i]->massG() / 2000 * 9.81;
  }
  EXPECT_NEAR(torque_Nmm, 0, 1e-6);
}

TEST(Elbow, StaysWhereItSettled) {
  Simulation simulation(withParameters({}));
  Robot& robot = simulation.build("elbow");
  simulation.settle({0.5, 0.4});
  const double angle_deg = robot.getState().angle_deg[0];
  simulation.start("settled", {0.5, 0.4});
  EXPECT_EQ(simulation.time_s(), 0);
  EXPECT_NEAR(robot.getState().angle_deg[0], angle_deg, 0.05);
  EXPECT_LT(simulation.largestGap().gap_mm, 0.01);
}

TEST(Elbow, ItsStopsHold) {
  for (const double sign : {1.0, -1.0}) {
    SimulationOptions options = withParameters({{"elbow.minimum_length_mm", 30}});
    options.step_s = 0.001;
    options.substeps = 1;
    Simulation simulation(options);
    Robot& robot = simulation.build("elbow");
    simulation.start("built", {0, 0});
    for (int i = 0; i < 500; ++i) {
      dBodyAddTorque(simulation.world().primitives()[0]->body().id, 0, 0, sign * 4e9);
      simulation.step();
      ASSERT_LT(std::abs(robot.getState().angle_deg[0]), 75);
    }
    EXPECT_NEAR(robot.getState().angle_deg[0], sign * 70, 0.3);
  }
}

TEST(Elbow, SettlesNoFartherThanItsStops) {
  Simulation simulation(withParameters({{"elbow.stop_deg", 10}}));
  Robot& robot = simulation.build("elbow");
  simulation.settle({1, 0});
  EXPECT_NEAR(robot.getState().angle_deg[0], 10, 1e-9);
}

TEST(Elbow, ParametersThatCannotBeAreRefused) {
  for (const auto& wrong : {std::pair{"elbow.forearm_kg", 0.0},
                            {"elbow.forearm_inertia_kgm2", 0.008},
                            {"elbow.stop_deg", 171.0},
                            {"elbow.maximum_length_mm", 200.0},
                            {"elbow.minimum_length_mm", 290.0}}) {
    Simulation simulation(withParameters({{wrong.first, wrong.second}}));
    EXPECT_THROW(simulation.build("elbow"), BadParameter) << wrong.first << " = " << wrong.second;
  }
}

}  // namespace
}  // namespace musclesim
