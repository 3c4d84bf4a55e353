#include <gtest/gtest.h>

#include "musclesim/simulation/simulation.h"

namespace musclesim {
namespace {

SimulationOptions benchOptions(const std::string& muscle_model) {
  SimulationOptions result;
  result.parameters.set("muscle.model", muscle_model, "test");
  result.parameters.set("force_law.name", "chou-hannaford", "test");
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, double>>{{"braid_N", 838}, {"bore_N", 395}, {"threshold_N", 76}, {"stretch_N", 0}})
    result.parameters.set("force_law." + name, value, "test");
  return result;
}

TEST(SpringBench, ReportsOneMuscle) {
  Simulation simulation(benchOptions("line"));
  EXPECT_EQ(simulation.build("spring_bench").signalNames(),
            (std::vector<std::string>{"command_0", "pressure_0", "force_0_N", "length_0_mm"}));
}

TEST(SpringBench, TheMuscleBalancesSpringAndLoad) {
  for (const char* model : {"line", "chain"})
    for (const double pressure : {0.4, 0.7, 1.0}) {
      Simulation simulation(benchOptions(model));
      Robot& robot = simulation.build("spring_bench");
      simulation.settle({pressure});
      const double length_mm = robot.getState().length_mm[0];
      EXPECT_NEAR(robot.actuators()[0]->calculateForce(pressure, length_mm), 20 + 5 * (250 - length_mm), 1e-6) << model << pressure;
    }
}

TEST(SpringBench, StaysAtItsEquilibrium) {
  Simulation simulation(benchOptions("line"));
  Robot& robot = simulation.build("spring_bench");
  simulation.start("settled", {0.7});
  const double length_mm = robot.getState().length_mm[0];
  simulation.advance(1);
  EXPECT_NEAR(robot.getState().length_mm[0], length_mm, 0.05);
}

TEST(SpringBench, AStifferSpringShortensTheStroke) {
  double lengths_mm[2];
  for (int i = 0; i < 2; ++i) {
    SimulationOptions stiff = benchOptions("line");
    stiff.parameters.set("spring_bench.spring_N_per_mm", i == 0 ? 1.0 : 20.0, "test");
    Simulation simulation(stiff);
    Robot& robot = simulation.build("spring_bench");
    simulation.settle({0.8});
    lengths_mm[i] = robot.getState().length_mm[0];
  }
  EXPECT_LT(lengths_mm[0], lengths_mm[1] - 5);
}

}  // namespace
}  // namespace musclesim
