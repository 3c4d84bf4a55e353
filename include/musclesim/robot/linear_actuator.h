/// An actuator with a single link on a straight line.
#pragma once

#include "musclesim/robot/actuator.h"

namespace musclesim {

/// One link from start to end; keeps the minimum length it is given. Its slider stops where the two beads touch, below that length.
class LinearActuator : public Actuator {
 public:
  /// Points in mm, world frame; lengths in mm. Throws like Muscle.
  LinearActuator(dWorldID world, dSpaceID space, const Vector& start, const Vector& end, double minimum_length, double maximum_length);
};

}  // namespace musclesim
