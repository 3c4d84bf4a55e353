/// The window of runs that follow each other.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "pictures.h"
#include "simulation/display/run_request.h"
#include "spectator.h"

namespace musclesim::command_line {

class RunWindow : public Spectator {
 public:
  /// A run begins: the window opens, or shows this run from now on. `run`: with hands, robot and controller; the rest is filled in.
  /// The window saves pictures in `folder`, that of the first run. Throws BadParameter if there is no display.
  virtual void begin(ShownRun run, Simulation& simulation, const State& first, const std::string& folder) = 0;
  /// The run that the user wants next, once; none: no other.
  virtual std::optional<RunRequest> takeRequest() = 0;
  virtual bool isAsked() const = 0;
  /// Shows the user a line for some seconds.
  virtual void say(const std::string& message) = 0;
};

/// A window that sets the speed of its runs. It writes a line of JSON per key or click to `log_file` (empty: no log). Throws BadParameter
/// for a build without a window.
std::unique_ptr<RunWindow> makeRunWindow(const PictureOptions& options, const std::string& log_file);

}  // namespace musclesim::command_line
