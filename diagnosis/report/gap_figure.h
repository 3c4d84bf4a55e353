/// The figure of a replay: for every signal, what was measured, what was simulated and what is left between them; then loops.
#pragma once

#include <string>
#include <vector>

#include "../data/replay_gap.h"

namespace musclesim {

/// Draws two diagrams per signal: measured and simulated over time, and the residual (measured minus simulated) over time with its noise
/// band. Below them, measured and simulated loops: the length of each muscle over its pressure, and each angle over the pressure that goes
/// with it most (greatest correlation of the measured values). Returns a self-contained SVG.
std::string gapFigureSvg(const std::string& title, const std::vector<ReplayGap>& gaps);

}  // namespace musclesim
