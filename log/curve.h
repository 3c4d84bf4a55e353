/// Turns signals into lines of a figure, with gaps where nothing was measured and no more points than pixels can show.
#pragma once

#include <vector>

#include "axis.h"
#include "svg.h"

namespace musclesim {

/// How a line connects the samples of a signal.
enum class Between { straight, held };

/// The pieces of a curve, split where a value is NaN. Of the samples within one pixel column only the lowest and the highest are kept, in
/// their order, so that a spike of one sample stays visible.
std::vector<std::vector<SvgPoint>> curvePieces(const std::vector<double>& time_s, const std::vector<double>& values, const Axis& time_axis,
                                               const Axis& value_axis, Between between);

}  // namespace musclesim
