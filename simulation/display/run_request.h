/// Runs that follow each other in one window.
#pragma once

#include <memory>
#include <string>

#include "musclesim/controller/hands.h"
#include "simulation/scene/camera.h"

namespace musclesim {

/// A run that the user wants next.
struct RunRequest {
  std::string robot;
  std::string controller;      ///< empty: the robot's usual one
  InputHistory repeated = {};  ///< inputs that it repeats, at full speed, before the user goes on; empty: it begins anew
  std::string recording = {};  ///< file name of the recording of the run that had these inputs
};

/// The run that a window shows.
struct ShownRun {
  std::shared_ptr<Hands> hands;
  std::string robot, controller;
  std::string recording = {};  ///< file name of its recording
  std::string title = {};
  Camera camera = {};  ///< the first view
};

}  // namespace musclesim
