/// How a window is opened.
#pragma once

#include <string>

#include "simulation/scene/camera.h"

namespace musclesim {

struct DisplayOptions {
  std::string title = "musclesim";
  int width_px = 1024, height_px = 768;
  double speed_ratio = 1;  ///< simulated time over wall time
  Camera camera;
  std::string picture_folder;  ///< where the keys s and v put pictures and videos
  std::string log_file;        ///< one line of JSON per key or click with the state after it; empty: none
};

}  // namespace musclesim
