/// Runs the fall of a robot that was imported: no contacts, no pressures.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "import/import.h"
#include "musclesim/robot/robot_file.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

/// Joints give way a little: with the default of constraint_force_mixing 1 N m bends a hinge by 0.01 degrees. Falls that make much of small
/// differences need harder ones.
constexpr double hard = 1e-14, usual = 1e-10;

/// The solver's error falls with the first power of its step.
inline std::unique_ptr<Simulation> simulationOf(const ImportedRobot& robot, int substeps = 100, double constraint_force_mixing = usual) {
  SimulationOptions options;
  options.step_s = 0.01;
  options.substeps = substeps;
  options.parameters.set("physics.contacts", "off", "test");
  options.parameters.set("physics.constraint_force_mixing", constraint_force_mixing, "test");
  auto simulation = std::make_unique<Simulation>(options);
  simulation->build([&](World& world) { return makeRobotFromText(robot.toml, "imported.toml", world); });
  return simulation;
}

/// Calls `see` with the time and the joint angles after every control step of 1 s.
inline void fall(Simulation& simulation, const std::function<void(double time_s, const std::vector<double>& angle_deg)>& see) {
  simulation.start("built", Action(static_cast<std::size_t>(simulation.robot().actuatorCount()), 0.0));
  constexpr int step_count = 100;
  for (int step = 0; step < step_count; ++step) {
    simulation.step();
    see(simulation.time_s(), simulation.robot().getState().angle_deg);
  }
}

/// Replaces every occurrence; for changes to descriptions that a test wants for both programs.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) text.replace(at, what.size(), by);
  return text;
}

}  // namespace musclesim
