/// --screenshot and --video: pictures of a simulation without a display.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/simulation/simulation.h"
#include "options.h"
#include "spectator.h"

namespace musclesim::program {

struct PictureOptions {
  std::optional<std::string> screenshot, video;
  std::vector<int> size_px = {1024, 768};
  std::vector<float> camera;    ///< azimuth and elevation in degrees, distance in mm; empty: the robot's own view
  std::optional<double> speed;  ///< simulated time over time of the video or of the wall
  bool wanted() const { return screenshot || video; }
  /// Throws BadParameter for options that would be without effect where no window opens. `why` says why none does.
  void requireUsed(const std::string& why = "no window opens here") const;
};

void addPictureOptions(CLI::App& command, PictureOptions& options, const std::string& group);

/// Simulated time over time of the viewer's clock: --speed, or 1; in `original` units, where all is slower, 10. Throws BadParameter unless
/// it is positive and finite.
double speedRatio(const PictureOptions& options, const PhysicsSettings& physics);

/// Draws the frames of --video as the run goes on and --screenshot at its end, and says on standard output where they are.
/// Throws BadParameter if this build cannot draw or there is no OSMesa.
std::unique_ptr<Spectator> makePictures(const PictureOptions& options, Simulation& simulation);

}  // namespace musclesim::program
