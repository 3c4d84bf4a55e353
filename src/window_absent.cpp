/// Replaces window.cpp in a build without the libraries for a window.
#include "musclesim/base/error.h"
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

}  // namespace musclesim::command_line
