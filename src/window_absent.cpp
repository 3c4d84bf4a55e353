/// Replaces window.cpp in a build without the libraries for a window.
#include "musclesim/base/error.h"
#include "replay_window.h"
#include "window.h"

namespace musclesim::command_line {

void requireWindow() {
  throw BadParameter("this build has no window: use --simple to run without one, --screenshot or --video for pictures");
}

std::unique_ptr<Spectator> openWindow(const PictureOptions&, Simulation&, ManualController&, const State&, const std::string&,
                                      const std::string&) {
  requireWindow();
  return nullptr;
}

std::unique_ptr<ReplayWindow> makeReplayWindow(const Recording&, const ReplayOptions&, MeasuredPoses&, const ReplayWindowOptions&) {
  requireWindow();
  return nullptr;
}

}  // namespace musclesim::command_line
