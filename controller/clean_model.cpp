#include "clean_model.h"

#include "musclesim/base/error.h"
#include "musclesim/robot/robot_registry.h"

namespace musclesim {

namespace {

/// The options of the robot's own world.
WorldOptions optionsOf(const Robot& robot) {
  if (robot.actuators().empty()) throw BadParameter("a robot without muscles has no model to control it by");
  const World& world = robot.actuators().front()->world();
  return {world.physics().kind, false, world.seed(), world.clock().stepS(), world.parameters()};
}

}  // namespace

CleanModel::CleanModel(const Robot& robot) : world_(optionsOf(robot)), effects_(world_, {}) {
  world_.connect(&effects_);
  robot_ = makeRobot(robot.descriptionFile().empty() ? robot.name() : robot.descriptionFile(), world_);
  effects_.attach(*robot_);
  for (Actuator* actuator : world_.actuators()) actuator->finishPath();
}

}  // namespace musclesim
