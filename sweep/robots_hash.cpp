#include "robots_hash.h"

#include "musclesim/base/hash.h"
#include "musclesim/robot/robot_registry.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

namespace {

void add(Hash& hash, const Parameter& parameter) {
  hash.add(parameter.name);
  if (const auto* number = std::get_if<double>(&parameter.value))
    hash.add(*number);
  else
    hash.add(std::get<std::string>(parameter.value));
}

void addRobot(Hash& hash, const std::string& name) {
  Simulation simulation;
  simulation.build(name);
  hash.add(name);
  for (const auto& primitive : simulation.world().primitives()) {
    hash.add(primitive->name());
    hash.add(primitive->massG());
    const Vector place_mm = primitive->getPosition();
    for (int axis = 0; axis < 3; ++axis) hash.add(place_mm[axis]);
  }
  for (const auto& actuator : simulation.world().actuators()) {
    hash.add(actuator->name());
    for (const double number : {actuator->lengthMm(), actuator->minimumLengthMm(), actuator->maximumLengthMm(), actuator->massG(),
                                actuator->calculateForce(0.5, actuator->lengthMm())})
      hash.add(number);
  }
  for (const Parameter& parameter : simulation.parameters().declared()) add(hash, parameter);
}

}  // namespace

std::string robotsHash() {
  Hash hash;
  for (const auto& [name, description] : registeredRobots()) addRobot(hash, name);
  return hash.text();
}

}  // namespace musclesim
