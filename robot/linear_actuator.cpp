#include "musclesim/robot/linear_actuator.h"

namespace musclesim {

LinearActuator::LinearActuator(dWorldID world, dSpaceID space, const Vector& start, const Vector& end, double minimum_length,
                               double maximum_length)
    : Actuator(world, space, {start, end}, minimum_length, minimum_length, maximum_length) {}

}  // namespace musclesim
