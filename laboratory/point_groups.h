/// Static points of one pressure, or of one length.
#pragma once

#include <vector>

#include "static_points.h"

namespace musclesim {

/// Points that share a pressure or a length, or a bin of it.
struct PointGroup {
  double value = 0;             ///< mean pressure ratio, or length in mm
  std::vector<std::size_t> of;  ///< indices of the points
};

/// Groups in increasing order. Values within 0.2 % of full scale or of the longest length are one; if that makes more than 40 groups (a
/// pressure that was swept), 10 bins of equal width are made instead.
std::vector<PointGroup> groupByPressure(const std::vector<StaticPoint>& points);
std::vector<PointGroup> groupByLength(const std::vector<StaticPoint>& points);

}  // namespace musclesim
