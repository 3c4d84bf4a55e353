/// The window of a replay.
#pragma once

#include <memory>
#include <string>

#include "musclesim/log/recording.h"
#include "musclesim/simulation/replay.h"
#include "pictures.h"
#include "simulation/measured_pose.h"

namespace musclesim::command_line {

struct ReplayWindowOptions {
  PictureOptions pictures;
  std::string folder;    ///< for pictures and videos
  std::string log_file;  ///< see makeRunWindow
  bool quiet = false;
};

/// Keeps the poses of a replay, and shows them when it has been simulated.
class ReplayWindow {
 public:
  virtual ~ReplayWindow() = default;
  /// For ReplayOptions::watch of the replay.
  virtual ReplayOptions::Watcher watch(Simulation& simulation) = 0;
  /// Simulates the recording without the effects of the options, too, if there are any; then plays both until the user closes the window.
  /// Throws SceneError if there is no display, IoError if it is lost.
  virtual void show(const ReplayResult& result) = 0;
};

/// Throws BadParameter if this build has no window. Everything that is passed must outlive the window.
std::unique_ptr<ReplayWindow> makeReplayWindow(const Recording& recording, const ReplayOptions& options, MeasuredPoses& poses,
                                               const ReplayWindowOptions& window);

}  // namespace musclesim::command_line
