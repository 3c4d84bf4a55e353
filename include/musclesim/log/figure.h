/// The figure of a run: the paper's Figure 11 as a self-contained SVG.
#pragma once

#include <string>
#include <vector>

#include "musclesim/base/color.h"
#include "musclesim/log/recording.h"

namespace musclesim {

/// Figure 11: above, the hand's height (red), the target (orange) and the activity (green, axis on the right); below, the pressures
/// (or, without measured pressures, the commands) of all muscles in their colours. Recordings without a hand show the angles or lengths
/// above. If `muscle_colors` is shorter than the number of muscles, the other muscles get distinguishable colours.
std::string runFigureSvg(const Recording& recording, const std::vector<Color>& muscle_colors, const std::string& title);

/// Writes runFigureSvg to a file. Throws IoError.
void writeRunFigure(const Recording& recording, const std::vector<Color>& muscle_colors, const std::string& title,
                    const std::string& svg_file);

}  // namespace musclesim
