#include "point_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"
#include "point_checks.h"
#include "point_columns.h"
#include "reading_units.h"

namespace musclesim {

namespace {

/// What a mapping file says of the table. It may have only what is of use for static points.
ImportMapping mappingOf(const StaticPointsOptions& options) {
  if (options.mapping.empty()) return {};
  ImportMapping mapping = readImportMapping(options.mapping);
  if (mapping.has_rows || mapping.clock)
    mapping.refuse(mapping.has_rows ? "rows" : "columns", "static points have no time: neither time_s nor [rows] can be used");
  for (const ImportColumn& column : mapping.columns) {
    const std::string quantity = column.written.substr(0, column.written.find('_'));
    const bool is_plain = column.written == quantity || unitAtEnd(column.written);
    if ((quantity != "pressure" && quantity != "length" && quantity != "force") || !is_plain ||
        std::ranges::count(column.written, '_') > 1 || column.clock)
      mapping.refuse("columns." + column.written,
                     "static points have pressure (a fraction) or pressure_kPa, length_mm and force_N, or these in other units, all from "
                     "one table");
  }
  return mapping;
}

/// A name that the table does not have is a fault of the mapping.
void requireColumnsOf(const ImportMapping& mapping, const DataTable& table) {
  for (const ImportColumn& column : mapping.columns) try {
      if (!column.from.empty()) table.indexOf(column.from);
    } catch (const BadFile& error) {
      mapping.refuse("columns." + column.written, error.what());
    }
}

/// Rows of the table that pass the filters. Pressures are in kPa or fractions, as in the file; lengths in mm, forces in N.
std::vector<StaticPoint> readRows(const DataTable& table, const PointColumns& columns, StaticPoints& result) {
  std::vector<StaticPoint> points;
  int unmeasured_count = 0;
  for (std::size_t row = 0; row < table.rowCount(); ++row) {
    if (!columns.selects(row)) continue;
    StaticPoint point;
    point.line = table.line(row);
    point.pressure_ratio = columns.pressure().value(table, row);
    point.length_mm = columns.length().value(table, row);
    point.force_N = columns.force().value(table, row);
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

StaticPoints pointsOf(const DataTable& table, const StaticPointsOptions& options, const ImportMapping& mapping) {
  StaticPoints result;
  result.file = table.file();
  requireColumnsOf(mapping, table);
  const PointColumns columns(table, options, mapping.columns);
  result.notes = table.notes();
  if (const auto& assumed = columns.assumed(); !assumed.empty())
    result.notes.push_back(fmt::format("no unit is given; assumed: {}", fmt::join(assumed, ", ")));
  if (const auto ignored = columns.ignored(); !ignored.empty())
    result.notes.push_back(fmt::format("columns not used: {}", fmt::join(ignored, ", ")));
  result.points = readRows(table, columns, result);
  requirePoints(result, options);
  scalePressures(result, columns, options);
  markCensored(result, options);
  requireMuscle(result);
  return result;
}

}  // namespace

StaticPoints readStaticPoints(const std::string& file, const StaticPointsOptions& options) {
  const ImportMapping mapping = mappingOf(options);
  return pointsOf(DataTable(file, mapping.format), options, mapping);
}

StaticPoints parseStaticPoints(const std::string& text, const std::string& file, const StaticPointsOptions& options) {
  const ImportMapping mapping = mappingOf(options);
  return pointsOf(DataTable(text, file, mapping.format), options, mapping);
}

}  // namespace musclesim
