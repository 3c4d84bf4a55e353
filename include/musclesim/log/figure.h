/// Figures of recordings, as self-contained SVG: the paper's Figure 11, and any signals over time.
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

/// The chosen signals of a recording over time, one diagram per quantity and unit (targets with what they are the target of), in the order
/// of the names. A name may end in *: "angle_*" stands for all signals that begin so. Throws BadParameter for a name that no signal has;
/// the message gives the nearest.
std::string signalsFigureSvg(const Recording& recording, const std::vector<std::string>& signals, const std::vector<Color>& muscle_colors,
                             const std::string& title);

/// Writes runFigureSvg to a file. Throws IoError.
void writeRunFigure(const Recording& recording, const std::vector<Color>& muscle_colors, const std::string& title,
                    const std::string& svg_file);

}  // namespace musclesim
