#include "point_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/log/csv.h"
#include "point_checks.h"
#include "point_columns.h"

namespace musclesim {

namespace {

/// Rows of the file that pass the filters. Pressures are in kPa or fractions, as in the file; lengths in mm, forces in N.
std::vector<StaticPoint> readRows(CsvReader& reader, const PointColumns& columns, StaticPoints& result) {
  std::vector<StaticPoint> points;
  std::vector<CsvCell> cells;
  int unmeasured_count = 0;
  while (reader.readRow(cells)) {
    if (!columns.selects(cells)) continue;
    StaticPoint point;
    point.line = reader.line();
    point.pressure_ratio = columns.pressure().value(reader, cells);
    point.length_mm = columns.length().value(reader, cells);
    point.force_N = columns.force().value(reader, cells);
    if (std::isnan(point.pressure_ratio + point.length_mm + point.force_N))
      ++unmeasured_count;
    else
      points.push_back(point);
  }
  if (unmeasured_count > 0)
    result.notes.push_back(fmt::format("{} rows without a pressure, length or force are skipped", unmeasured_count));
  return points;
}

void scalePressures(StaticPoints& points, const PointColumns& columns, const StaticPointsOptions& options) {
  if (!columns.pressureHasUnit()) {
    if (options.full_scale_kPa) points.notes.push_back("pressures are fractions already; --full-scale-kPa changes nothing");
    return;
  }
  double largest_kPa = 0;
  for (const auto& point : points.points) largest_kPa = std::max(largest_kPa, point.pressure_ratio);
  points.full_scale_kPa = options.full_scale_kPa.value_or(largest_kPa);
  if (!(*points.full_scale_kPa > 0)) throw BadFile(points.file, "all pressures are 0");
  for (auto& point : points.points) point.pressure_ratio /= *points.full_scale_kPa;
  if (!options.full_scale_kPa)
    points.notes.push_back(
        fmt::format("pressure 1 is the largest in the file, {:g} kPa; set another with --full-scale-kPa", *points.full_scale_kPa));
}

/// The sensor's floor: a sensor that cannot read lower values gives its floor repeatedly.
std::optional<double> repeatedFloorN(const std::vector<StaticPoint>& points) {
  const auto lowest = std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.force_N < b.force_N; });
  if (lowest == points.end() || lowest->force_N > 0) return std::nullopt;
  const auto count = std::count_if(points.begin(), points.end(), [&](const auto& point) { return point.force_N == lowest->force_N; });
  constexpr double repeated_share = 0.01;
  const bool is_floor = count >= 3 && static_cast<double>(count) >= repeated_share * static_cast<double>(points.size());
  return is_floor ? std::optional(lowest->force_N) : std::nullopt;
}

void markCensored(StaticPoints& points, const StaticPointsOptions& options) {
  const auto floor_N = options.censored_below_N ? options.censored_below_N : repeatedFloorN(points.points);
  if (!floor_N) return;
  points.floor_N = *floor_N;
  for (auto& point : points.points) point.censored = point.force_N <= *floor_N;
  if (points.censoredCount() > 0)
    points.notes.push_back(
        fmt::format("{} of {} points are at or below {:g} N and count as \"not above {:g} N\"{}", points.censoredCount(),
                    points.points.size(), *floor_N, *floor_N,
                    options.censored_below_N ? "" : " (the lowest force occurs repeatedly; set another limit with --censored-below)"));
}

}  // namespace

StaticPoints readStaticPoints(const std::string& file, const StaticPointsOptions& options) {
  return parseStaticPoints(readTextFile(file, CsvLimits().file_bytes), file, options);
}

StaticPoints parseStaticPoints(const std::string& text, const std::string& file, const StaticPointsOptions& options) {
  StaticPoints result;
  result.file = file;
  CsvReader reader(text, file);
  const PointColumns columns(reader, file, options);
  if (const auto& assumed = columns.assumed(); !assumed.empty())
    result.notes.push_back(fmt::format("no unit is given; assumed: {}", fmt::join(assumed, ", ")));
  if (const auto& ignored = columns.ignored(); !ignored.empty())
    result.notes.push_back(fmt::format("columns not used: {}", fmt::join(ignored, ", ")));
  result.points = readRows(reader, columns, result);
  requirePoints(result, options);
  scalePressures(result, columns, options);
  markCensored(result, options);
  requireMuscle(result);
  return result;
}

}  // namespace musclesim
