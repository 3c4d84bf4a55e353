/// Robot descriptions of other programs (URDF, SDF, MuJoCo's MJCF) become robot descriptions `musclesim-robot-1`.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

/// A robot description and what the reader of it should know.
struct ImportedRobot {
  std::string toml;                ///< the text of a `musclesim-robot-1` file; the notes stand at its head as comments
  std::vector<std::string> notes;  ///< what is not taken over, or taken over in another way, item by item
};

/// Reads a URDF, SDF or MJCF file; its outermost element (`robot`, `sdf`, `mujoco`) says which one it is.
///
/// Frames and units: (x, y, z) with z up becomes (x, z, -y) with y up; metres, kilograms and radians become mm, g and degrees.
/// Throws IoError if the file cannot be read, BadFile with the line if it is not valid or describes something that a robot here cannot
/// have, BadParameter if this program was built without the library that reads the format.
ImportedRobot importRobot(const std::string& file);

}  // namespace musclesim
