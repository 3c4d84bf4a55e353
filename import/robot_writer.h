/// Writes a robot that was imported as a `musclesim-robot-1` file.
#pragma once

#include <string>

#include "source_robot.h"

namespace musclesim {

/// The text of the file: notes as comments, then bodies, joints, pulleys, muscles and springs, in mm, g, degrees and with y up.
/// The robot must have gone through prepare().
std::string robotToml(const SourceRobot& robot);

}  // namespace musclesim
