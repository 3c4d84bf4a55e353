#include "musclesim/robot/robot_registry.h"

#include <fmt/format.h>

#include <map>
#include <mutex>

#include "musclesim/base/error.h"
#include "musclesim/robot/robot_file.h"
#include "musclesim/robot/robotic_arm.h"

namespace musclesim {

namespace {

struct RegisteredRobot {
  std::string description;
  RobotFactory build;
};

std::map<std::string, RegisteredRobot> builtIn() {
  std::map<std::string, RegisteredRobot> robots = {
      {"arm",
       {"the paper's RoboticArm: shoulder, elbow, wrist and ten muscles (up to 30)",
        [](World& world) { return std::make_unique<RoboticArm>(world); }}},
  };
  for (const ShippedRobot& shipped : shippedRobots())
    robots[shipped.name] = {shipped.description, [name = shipped.name](World& world) { return makeShippedRobot(name, world); }};
  return robots;
}

std::map<std::string, RegisteredRobot>& robotRegistry() {
  static std::map<std::string, RegisteredRobot> robots = builtIn();
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
