#include <gtest/gtest.h>

#include <cmath>

#include "musclesim/base/units.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// Muscles that are slack at rest and shorten by a quarter at full pressure.
SimulationOptions options(const std::string& muscle_model, std::vector<std::pair<std::string, double>> more = {}) {
  SimulationOptions result;
  result.parameters.set("muscle.model", muscle_model, "test");
  result.parameters.set("force_law.name", "chou-hannaford", "test");
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, double>>{{"braid_N", 838}, {"bore_N", 395}, {"threshold_N", 76}, {"stretch_N", 0}})
    result.parameters.set("force_law." + name, value, "test");
  for (const auto& [name, value] : more) result.parameters.set(name, value, "test");
  return result;
}

TEST(Wrist, ReportsTwoMusclesOneAngleAndTheHand) {
  Simulation simulation(options("line"));
  Robot& robot = simulation.build("wrist");
  EXPECT_EQ(robot.signalNames(),
            (std::vector<std::string>{"command_0", "command_1", "pressure_0", "pressure_1", "force_0_N", "force_1_N", "length_0_mm",
                                      "length_1_mm", "angle_wrist_deg", "hand_x_mm", "hand_y_mm", "hand_z_mm"}));
  EXPECT_EQ(robot.initialState(), "settled");
}

TEST(Wrist, TheVentedHandLiesOnTheLowStopAndMuscle0RaisesIt) {
  Simulation simulation(options("line"));
  Robot& robot = simulation.build("wrist");
  simulation.settle({0, 0});
  EXPECT_NEAR(robot.getState().angle_deg[0], -2, 1e-6);
  simulation.settle({1, 0.2});
  EXPECT_GT(robot.getState().angle_deg[0], 40);
  simulation.settle({0.2, 1});
  EXPECT_NEAR(robot.getState().angle_deg[0], -2, 1e-6);
}

TEST(Wrist, EqualMusclesWithoutWeightBalanceInTheMiddle) {
  for (const char* model : {"line", "chain"}) {
    Simulation simulation(options(model, {{"wrist.hand_kg", 1e-4}, {"wrist.center_of_mass_mm", 0}, {"muscle.bead_mass_g", 1e-3}}));
    Robot& robot = simulation.build("wrist");
    simulation.settle({0.6, 0.6});
    EXPECT_NEAR(robot.getState().angle_deg[0], 35, 0.01) << model;
    EXPECT_NEAR(robot.getState().length_mm[0], 200, 0.01) << model;
  }
}

TEST(Wrist, LengthsFollowTheLever) {
  Simulation simulation(options("line"));
  Robot& robot = simulation.build("wrist");
  simulation.settle({0.8, 0.4});
  const State state = robot.getState();
  const double turned_rad = (state.angle_deg[0] - 35) * rad_per_deg;
  const Vector upper(25, 200, 0), lower = 25 * Vector(std::cos(turned_rad), std::sin(turned_rad), 0);
  EXPECT_NEAR(state.length_mm[0], (upper - lower).norm(), 1e-9);
}

TEST(Wrist, StaysAtItsEquilibrium) {
  Simulation simulation(options("line"));
  Robot& robot = simulation.build("wrist");
  simulation.start("settled", {0.8, 0.4});
  const double angle_deg = robot.getState().angle_deg[0];
  simulation.advance(1);
  EXPECT_NEAR(robot.getState().angle_deg[0], angle_deg, 0.05);
}

}  // namespace
}  // namespace musclesim
