/// Static points of one pressure, or of one length.
#pragma once

#include <vector>

#include "static_points.h"

namespace musclesim {

/// Points of the same pressure or length, or of one bin of pressures or lengths.
struct PointGroup {
  double value = 0;             ///< mean pressure ratio, or length in mm
  std::vector<std::size_t> of;  ///< indices of the points
};

/// Groups in increasing order. Values within 0.2 % of full scale (or of the longest length) form one group. If that gives more than 40
/// groups, as for a swept pressure, 10 bins of equal width are used instead.
std::vector<PointGroup> groupByPressure(const std::vector<StaticPoint>& points);
std::vector<PointGroup> groupByLength(const std::vector<StaticPoint>& points);

}  // namespace musclesim
