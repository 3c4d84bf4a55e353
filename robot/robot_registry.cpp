#include "musclesim/robot/robot_registry.h"

#include <fmt/format.h>

#include <map>
#include <mutex>

#include "musclesim/base/error.h"
#include "musclesim/robot/elbow.h"
#include "musclesim/robot/rig.h"
#include "musclesim/robot/robot_file.h"
#include "musclesim/robot/robotic_arm.h"
#include "musclesim/robot/spring_bench.h"
#include "musclesim/robot/wrist.h"

namespace musclesim {

namespace {

struct RegisteredRobot {
  std::string description;
  RobotFactory build;
};

template <class RobotType>
RegisteredRobot builtIn(const std::string& description) {
  return {description, [](World& world) { return std::make_unique<RobotType>(world); }};
}

std::map<std::string, RegisteredRobot>& robotRegistry() {
  static std::map<std::string, RegisteredRobot> robots = {
      {"arm", builtIn<RoboticArm>("the paper's RoboticArm: shoulder, elbow, wrist and ten muscles (up to 30)")},
      {"rig", builtIn<Rig>("the paper's load frame: one hanging muscle with a load")},
      {"elbow", builtIn<Elbow>("an antagonistic pair of muscles on one hinge")},
      {"wrist", builtIn<Wrist>("an antagonistic wrist between two stops")},
      {"spring_bench", builtIn<SpringBench>("one muscle that pulls a carriage against a spring")},
  };
  return robots;
}

/// Guards the registry: simulations are built in several threads.
std::mutex& robotRegistryMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

void registerRobot(const std::string& name, const std::string& description, RobotFactory build) {
  const std::lock_guard lock(robotRegistryMutex());
  robotRegistry()[name] = {description, std::move(build)};
}

std::unique_ptr<Robot> makeRobot(const std::string& name, World& world) {
  if (isRobotFile(name)) return makeRobotFromFile(name, world);
  RobotFactory build;
  {
    const std::lock_guard lock(robotRegistryMutex());
    if (const auto found = robotRegistry().find(name); found != robotRegistry().end()) build = found->second.build;
  }
  if (!build) {
    std::vector<std::string> names;
    for (const auto& [known, description] : registeredRobots()) names.push_back(known);
    const std::string nearest = nearestName(name, names);
    throw BadParameter(fmt::format("there is no robot \"{}\"{}; registered: {}; a robot of your own is a file, NAME.toml", name,
                                   nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?", fmt::join(names, ", ")));
  }
  auto robot = build(world);
  robot->setName(name);
  return robot;
}

std::vector<std::pair<std::string, std::string>> registeredRobots() {
  const std::lock_guard lock(robotRegistryMutex());
  std::vector<std::pair<std::string, std::string>> result;
  for (const auto& [name, entry] : robotRegistry()) result.emplace_back(name, entry.description);
  return result;
}

}  // namespace musclesim
