/// Replaces window.cpp in a build without the libraries for a window.
#include "musclesim/base/error.h"
#include "replay_window.h"
#include "window.h"

namespace musclesim::command_line {

namespace {

[[noreturn]] void refuseWindow() {
  throw BadParameter("this build has no window: use --simple to run without one, --screenshot or --video for pictures");
}

}  // namespace

std::unique_ptr<RunWindow> makeRunWindow(const PictureOptions&, const std::string&) {
  refuseWindow();
}

std::unique_ptr<ReplayWindow> makeReplayWindow(const Recording&, const ReplayOptions&, MeasuredPoses&, const ReplayWindowOptions&) {
  refuseWindow();
}

}  // namespace musclesim::command_line
