#include "static_points.h"

#include <algorithm>

namespace musclesim {

double StaticPoints::shortestMm() const {
  return std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.length_mm < b.length_mm; })->length_mm;
}

double StaticPoints::longestMm() const {
  return std::max_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.length_mm < b.length_mm; })->length_mm;
}

double StaticPoints::largestForceN() const {
  return std::max_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.force_N < b.force_N; })->force_N;
}

std::vector<StaticPoint> StaticPoints::measured() const {
  std::vector<StaticPoint> result;
  for (const auto& point : points)
    if (!point.censored && !point.outlier) result.push_back(point);
  return result;
}

int StaticPoints::censoredCount() const {
  return static_cast<int>(std::count_if(points.begin(), points.end(), [](const auto& point) { return point.censored; }));
}

}  // namespace musclesim
