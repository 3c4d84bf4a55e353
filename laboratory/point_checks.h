/// Whether a table can be static points of a muscle at all, before anything is fitted to it.
#pragma once

#include "static_points.h"

namespace musclesim {

/// Least number of points that any fit makes sense with.
inline constexpr std::size_t fewest_points = 8;

/// Throws BadFile for a table with too few points.
void requirePoints(const StaticPoints& points, const StaticPointsOptions& options);

/// Throws BadFile unless there are at least two pressures and two lengths, the lengths are those of one muscle, and the force grows with
/// pressure and with length.
void requireMuscle(const StaticPoints& points);

}  // namespace musclesim
