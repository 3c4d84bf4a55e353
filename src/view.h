/// The initial camera of a robot.
#pragma once

#include <string>
#include <vector>

#include "simulation/scene/camera.h"
#include "simulation/snapshot.h"

namespace musclesim::command_line {

/// Shows the arm from the same side as the published program, and any other robot as a whole. `given` holds the values of --camera, azimuth
/// and elevation in degrees and distance in mm, or is empty. Throws BadParameter for numbers out of range.
Camera initialCamera(const std::string& robot_name, const Snapshot& snapshot, const std::vector<float>& given);

}  // namespace musclesim::command_line
