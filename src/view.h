/// From where a robot is looked at in the beginning.
#pragma once

#include <string>
#include <vector>

#include "simulation/scene/camera.h"
#include "simulation/snapshot.h"

namespace musclesim::program {

/// The arm from the side that the published program shows, any other robot as a whole; `given` is --camera, azimuth and elevation in
/// degrees and distance in mm, or empty. Throws BadParameter for numbers out of range.
Camera initialCamera(const std::string& robot_name, const Snapshot& snapshot, const std::vector<float>& given);

}  // namespace musclesim::program
