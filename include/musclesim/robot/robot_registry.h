/// Robots by name.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/robot/robot.h"

namespace musclesim {

using RobotFactory = std::function<std::unique_ptr<Robot>(World&)>;

/// Registers what builds a robot under a name; a later registration of the same name replaces the earlier one.
void registerRobot(const std::string& name, const std::string& description, RobotFactory build);

/// Registers a robot class under a name:
///     registerRobot<MyJoint>("my-joint", "what it is");
template <class RobotType>
void registerRobot(const std::string& name, const std::string& description) {
  registerRobot(name, description, [](World& world) { return std::make_unique<RobotType>(world); });
}

/// Builds a registered robot in a world, or the one that a file describes if the name ends in ".toml" (makeRobotFromFile).
/// Throws BadParameter with the nearest name if there is none of that name.
std::unique_ptr<Robot> makeRobot(const std::string& name, World& world);

/// Names and descriptions of all registered robots, by name.
std::vector<std::pair<std::string, std::string>> registeredRobots();

}  // namespace musclesim
