/// The RoboticArm as a robot file.
#pragma once

#include <string>

namespace musclesim {

/// The arm of the table (robotic_arm_table.h) as text in the format musclesim-robot-1: the same bodies, joints and ten muscles.
std::string roboticArmFile();

}  // namespace musclesim
