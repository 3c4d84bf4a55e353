/// Checks that a table can be static points of a muscle, before anything is fitted to it.
#pragma once

#include "static_points.h"

namespace musclesim {

/// The least number of points for a fit.
inline constexpr std::size_t fewest_points = 8;

/// Throws BadFile for a table with too few points.
void requirePoints(const StaticPoints& points, const StaticPointsOptions& options);

/// Throws BadFile unless there are at least two pressures and two lengths, the lengths are those of one muscle, and the force grows with
/// pressure and with length.
void requireMuscle(const StaticPoints& points);

}  // namespace musclesim
