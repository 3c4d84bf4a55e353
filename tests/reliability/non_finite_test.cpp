/// Feeds impossible numbers to every input of numbers. Each is refused, or the run ends in Diverged within one step of the first number
/// that is not finite. There is never a crash and never a recorded value that is not finite.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "musclesim/base/error.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/log/recording.h"
#include "musclesim/robot/force_law.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/simulation/replay.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

/// An exception thrown during a step leaks ODE's list of jobs. Nothing else may leak.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:dxtemplateThreadingImplementation";
}

namespace musclesim {
namespace {

const std::vector<double> odd_values = {std::numeric_limits<double>::quiet_NaN(),
                                        std::numeric_limits<double>::infinity(),
                                        -std::numeric_limits<double>::infinity(),
                                        1e308,
                                        -1e308,
                                        -0.0,
                                        std::numeric_limits<double>::denorm_min()};

enum class End { refused, diverged, done };

/// How an action ends; any other end is an error of the program.
template <class Function>
End endOf(const Function& action) {
  try {
    action();
    return End::done;
  } catch (const BadParameter&) {
    return End::refused;
  } catch (const BadFile&) {
    return End::refused;
  } catch (const Diverged&) {
    return End::diverged;
  }
}

void requireFiniteState(Simulation& simulation) {
  for (const double value : simulation.robot().signalValues(simulation.robot().getState())) ASSERT_TRUE(std::isfinite(value));
}

/// Steps that must leave a finite state or throw.
void steps(Simulation& simulation, int count) {
  for (int i = 0; i < count; ++i) {
    simulation.step();
    requireFiniteState(simulation);
  }
}

Action held(Simulation& simulation) {
  return Action(static_cast<std::size_t>(simulation.robot().actuatorCount()), 0.3);
}

TEST(NonFinite, PressuresOfEveryMuscle) {
  int place_count = 0;
  for (const char* robot : {"rig", "elbow", "arm"})
    for (std::size_t muscle = 0;; ++muscle) {
      Simulation simulation;
      simulation.build(robot);
      if (muscle >= held(simulation).size()) break;
      simulation.start("built", held(simulation));
      simulation.step();
      ++place_count;
      for (const double value : odd_values) {
        Action action = held(simulation);
        action[muscle] = value;
        const End end = endOf([&] { simulation.robot().step(action); });
        const bool possible = value >= 0 && value <= 1;
        EXPECT_EQ(end, possible               ? End::done
                       : std::isfinite(value) ? End::refused
                                              : End::diverged)
            << robot << " " << muscle << " " << value;
        EXPECT_NO_THROW(requireFiniteState(simulation)) << "the last good state can be recorded";
      }
    }
  std::printf("places: %d\n", place_count);
  EXPECT_GE(place_count, 13);
}

/// A muscle with a force set by the test from a given step on.
class OddMuscle : public Muscle {
 public:
  using Muscle::Muscle;
  static inline double force_N = 0;
  double calculateForce(double pressure, double length_mm) const override {
    return std::isnan(force_N) || force_N != 0 ? force_N : Muscle::calculateForce(pressure, length_mm);
  }
};

class OddLever : public Robot {
 public:
  explicit OddLever(World& world) : Robot(world) {
    auto* bar = new Box(world, space(), {0, 0, 0}, 400, 0, 200, 20, 20);
    addAngle("lever", bar->attachHinge(nullptr, {0, 0, 0}, Vector::UnitZ(), -40, 40));
    auto* muscle = new OddMuscle(world, space(), {80, -260, 0}, {80, -180, 0}, {80, -100, 0}, {80, -10, 0}, 150, 320);
    muscle->connectStartTo(nullptr);
    muscle->connectEndTo(bar);
    addActuator(muscle);
  }
};

TEST(NonFinite, ForcesOfAnOwnLaw) {
  for (const StepperKind stepper : {StepperKind::automatic, StepperKind::ode, StepperKind::quick})
    for (const double value : odd_values) {
      OddMuscle::force_N = 0;
      SimulationOptions options;
      options.stepper = stepper;
      Simulation simulation(options);
      simulation.build<OddLever>();
      simulation.start("built", {0.3});
      steps(simulation, 3);
      OddMuscle::force_N = value;
      const End end = endOf([&] { steps(simulation, 2); });
      // A muscle cannot push: less than no force is none.
      EXPECT_EQ(end, value < 1 && std::isfinite(value) ? End::done : End::diverged) << value;
      OddMuscle::force_N = 0;
    }
}

/// A robot on which an effect acts, and the first component there.
std::pair<std::string, std::string> robotWith(const EffectInfo& info) {
  for (const char* robot : {"elbow", "rig"}) {
    Simulation simulation;
    const auto components = componentsFor(info, simulation.build(robot));
    if (!components.empty()) return {robot, components.front()};
  }
  throw std::logic_error("no robot here has a component for " + info.id);
}

TEST(NonFinite, EveryParameterOfEveryEffect) {
  int place_count = 0;
  for (const EffectInfo& info : effectCatalogue()) {
    const auto [robot, component] = robotWith(info);
    for (const EffectParameter& parameter : info.parameters) {
      if (!parameter.choices.empty()) continue;
      ++place_count;
      for (const double value : odd_values) {
        const End end = endOf([&] {
          SimulationOptions options;
          options.parameters.set("muscle.model", std::string("line"), "test");
          options.effects = {{info.id, component, {{parameter.name, value}}}};
          Simulation simulation(options);
          simulation.build(robot);
          simulation.start("built", held(simulation));
          steps(simulation, 5);
        });
        if (std::isnan(value)) {
          EXPECT_EQ(end, End::refused) << info.id << " " << parameter.name;
        }
      }
    }
  }
  std::printf("places: %d\n", place_count);
  EXPECT_GE(place_count, 30);
}

TEST(NonFinite, EveryNamedParameterOfTheRobots) {
  int place_count = 0;
  for (const char* robot : {"rig", "elbow"}) {
    Simulation probe;
    probe.build(robot);
    for (const Parameter& parameter : probe.parameters().declared()) {
      if (!parameter.choices.empty()) continue;
      ++place_count;
      for (const double value : odd_values) {
        const End end = endOf([&] {
          SimulationOptions options;
          options.parameters.set(parameter.name, value, "test");
          Simulation simulation(options);
          simulation.build(robot);
          simulation.start("built", held(simulation));
          steps(simulation, 2);
        });
        if (!std::isfinite(value)) {
          EXPECT_EQ(end, End::refused) << robot << " " << parameter.name << " " << value;
        }
      }
    }
  }
  std::printf("places: %d\n", place_count);
  EXPECT_GE(place_count, 20);
}

TEST(NonFinite, EveryColumnOfARecording) {
  const std::vector<std::string> columns = {"time_s", "command_0", "pressure_0", "force_0_N", "length_0_mm"};
  for (std::size_t odd_column = 0; odd_column < columns.size(); ++odd_column)
    for (const char* value : {"nan", "inf", "-inf", "1e308", "-1e308", "-0", "4.9e-324", "1e400"}) {
      std::string csv = "time_s,command_0,pressure_0,force_0_N,length_0_mm\n";
      for (int row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < columns.size(); ++column) {
          const std::string plain = column == 0 ? std::to_string(0.01 * row) : column == 4 ? "200" : "0.5";
          csv += (row == 1 && column == odd_column ? value : plain) + (column + 1 < columns.size() ? "," : "\n");
        }
      const End end = endOf([&] {
        const Recording recording = parseRecording(csv, "r.csv", R"({"format": "musclesim-recording-1", "robot": "rig"})", "r.json");
        const ReplayResult result = replayRecording(recording, {});
        for (const Signal& signal : result.simulated.signals)
          for (const double simulated : signal.values) ASSERT_TRUE(std::isfinite(simulated)) << signal.name;
      });
      if (std::string(value).find("inf") != std::string::npos || std::string(value) == "1e400") {
        EXPECT_EQ(end, End::refused) << columns[odd_column] << " " << value;
      }
    }
}

}  // namespace
}  // namespace musclesim
