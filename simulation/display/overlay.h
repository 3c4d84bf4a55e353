/// Text over the scene: state of the run, notices, labels, help, the banner of a divergence.
#pragma once

#include <string>
#include <vector>

#include "console.h"
#include "painter.h"
#include "simulation/snapshot.h"

namespace musclesim {

/// A line with wall time over simulated time, target and measured.
std::string paceLine(const Console& console);

/// What stands beside the poses of a replay: the effects, from what the ghost follows and how far it is from the
/// simulation, the RMS of the chosen signal's residual.
std::vector<std::string> replayLines(const Console& console, const Snapshot& snapshot);

/// Draws the whole overlay into the scene's part of the window.
void drawOverlay(Painter& painter, const Console& console, const Snapshot& snapshot, float width_px, float height_px, bool with_status);

}  // namespace musclesim
