/// Options of a window.
#pragma once

#include <string>
#include <vector>

#include "simulation/scene/camera.h"

namespace musclesim {

struct DisplayOptions {
  std::string title = "musclesim";
  int width_px = 1024, height_px = 768;
  double speed_ratio = 1;  ///< simulated time over wall time
  Camera camera;
  bool arrows = false;                           ///< contacts and tensions are shown as arrows from the beginning
  std::vector<std::string> robots, controllers;  ///< among which the panel lets the user choose
  std::string picture_folder;                    ///< folder for the pictures and videos of the keys s and v
  std::string log_file;                          ///< gets one line of JSON per key or click, with the state after it; empty: no log
};

}  // namespace musclesim
