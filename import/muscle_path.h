/// Paths of muscles of a robot that is imported: what the reader of robot files would refuse is taken out; lengths over the joints' ranges.
#pragma once

#include "source_robot.h"

namespace musclesim {

/// Takes pulleys out of paths that a muscle here cannot wrap around, drops muscles and springs that move nothing, and gives a range to
/// muscles that have none: the shortest and the longest path over the joints' limits. Says in the notes what it changed.
void preparePaths(SourceRobot& robot);

/// Length of a muscle's path in the pose as built, m.
double pathLengthM(const SourceRobot& robot, const SourceMuscle& muscle);

}  // namespace musclesim
