/// Diagrams of a gap over the whole recording, drawn with Dear ImGui.
#pragma once

#include "player.h"

namespace musclesim {

/// Draws at ImGui's cursor, `height_px` each: measured and simulated values of the chosen signal, then its residual with the noise band. A
/// line shows the present time.
void drawGapPlots(const Player& player, float height_px);

}  // namespace musclesim
