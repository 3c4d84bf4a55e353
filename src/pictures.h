/// --screenshot and --video: pictures of a simulation without a display.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/simulation/simulation.h"
#include "options.h"
#include "simulation/snapshot.h"
#include "spectator.h"

namespace musclesim::command_line {

struct PictureOptions {
  std::optional<std::string> screenshot, video;
  std::vector<int> size_px = {1024, 768};
  std::vector<float> camera;    ///< azimuth and elevation in degrees, distance in mm; empty: the robot's own view
  std::optional<double> speed;  ///< simulated time over time of the video or wall time
  bool arrows = false;          ///< contacts and tensions are shown as arrows
  bool wanted() const { return screenshot || video; }
  /// Throws BadParameter for options that have no effect because no window opens. `why` gives the reason for the message.
  void requireUsed(const std::string& why = "no window opens here") const;
};

void addPictureOptions(CLI::App& command, PictureOptions& options, const std::string& group);

/// Simulated time over time that the viewer sees: --speed if given, else 1, or 10 in `original` physics, where everything moves more
/// slowly. Throws BadParameter unless it is positive and finite.
double speedRatio(const PictureOptions& options, const PhysicsSettings& physics);

/// The ghost of the state that a spectator sees as its `index`-th, and its snapshot.
using GhostOf = std::function<std::shared_ptr<const DrawnGhost>(std::size_t index, const Snapshot& snapshot)>;

/// Draws the frames of --video during the run and the --screenshot at its end, and prints the paths of the files.
/// Throws BadParameter if this build cannot draw or there is no OSMesa.
std::unique_ptr<Spectator> makePictures(const PictureOptions& options, Simulation& simulation, GhostOf ghost_of = nullptr);

}  // namespace musclesim::command_line
