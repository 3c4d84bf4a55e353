/// An actuator with a single link on a straight line.
#pragma once

#include "musclesim/robot/actuator.h"

namespace musclesim {

/// One link from start to end. It keeps the given minimum length; its slider stops only below that length, where the two beads touch.
class LinearActuator : public Actuator {
 public:
  /// Points in mm, world frame; lengths in mm. Throws like Muscle.
  LinearActuator(dWorldID world, dSpaceID space, const Vector& start, const Vector& end, double minimum_length, double maximum_length);
};

}  // namespace musclesim
