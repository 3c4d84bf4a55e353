/// The window of a run.
#pragma once

#include <memory>
#include <string>

#include "musclesim/controller/manual.h"
#include "pictures.h"
#include "spectator.h"

namespace musclesim::command_line {

/// Opens a window that shows the run and sets its speed. It saves pictures in `folder` and writes a line of JSON per key or click to
/// `log_file` (empty: no log). Throws BadParameter if this build has no window or there is no display.
std::unique_ptr<Spectator> openWindow(const PictureOptions& options, Simulation& simulation, ManualController& hands, const State& first,
                                      const std::string& folder, const std::string& log_file);

/// Throws BadParameter, as openWindow, for a build without a window.
void requireWindow();

}  // namespace musclesim::command_line
