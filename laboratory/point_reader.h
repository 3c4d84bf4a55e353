/// Reads measured static points from a CSV file and checks them.
#pragma once

#include <string>

#include "static_points.h"

namespace musclesim {

/// Reads a CSV file with one column each of pressure (fraction), pressure_kPa, _bar or _MPa; length_mm, _cm or _m; force_N.
/// Throws BadFile, with line, value and allowed range, if no static test of a muscle can have given the table: missing units, values out of
/// range, lengths that differ too much, forces that fall with pressure or length (columns swapped), fewer than two pressures or lengths.
StaticPoints readStaticPoints(const std::string& file, const StaticPointsOptions& options = {});
/// Like readStaticPoints, from text; `file` is used in messages.
StaticPoints parseStaticPoints(const std::string& text, const std::string& file, const StaticPointsOptions& options = {});

}  // namespace musclesim
