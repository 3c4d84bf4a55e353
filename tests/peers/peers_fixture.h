/// Robots for other engines.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "musclesim/robot/robot_file.h"
#include "musclesim/simulation/simulation.h"
#include "peers/mechanism.h"

namespace musclesim::peers {

/// A simulation without contacts of a robot with a name, or of the text of a robot file, and what other engines read of it.
struct Sample {
  explicit Sample(const std::string& robot, const std::vector<std::string>& parameters = {}, int substeps = 0, double step_s = 0.01)
      : simulation(optionsOf(parameters, substeps, step_s)) {
    if (robot.find('\n') == std::string::npos)
      simulation.build(robot);
    else
      simulation.build([&](World& world) { return makeRobotFromText(robot, "robot.toml", world); });
    read();
  }
  /// Reads the robot again, in its present pose.
  void read() {
    mechanism = mechanismOf(simulation);
    tree = spanningTree(mechanism);
  }

  Simulation simulation;
  Mechanism mechanism;
  Tree tree;

 private:
  static SimulationOptions optionsOf(const std::vector<std::string>& parameters, int substeps, double step_s) {
    SimulationOptions options;
    options.step_s = step_s;
    options.substeps = substeps;
    options.parameters.set("physics.contacts", "off", "test");
    for (const std::string& assignment : parameters) options.parameters.setFromText(assignment, "test");
    return options;
  }
};

}  // namespace musclesim::peers
