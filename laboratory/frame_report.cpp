#include "frame_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "diagram.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/force_law_choice.h"

namespace musclesim {

namespace {

template <class Condition>
std::vector<FramePoint> pointsThat(const std::vector<FramePoint>& points, const Condition& condition) {
  std::vector<FramePoint> result;
  std::copy_if(points.begin(), points.end(), std::back_inserter(result), condition);
  return result;
}

/// Points of each pressure, in the order of measurement.
std::map<double, std::vector<FramePoint>> byPressure(const std::vector<FramePoint>& points) {
  std::map<double, std::vector<FramePoint>> result;
  for (const auto& point : points) result[point.pressure_ratio].push_back(point);
  return result;
}

double largestOffN(const std::vector<FramePoint>& points) {
  double largest_N = 0;
  for (const auto& point : points) largest_N = std::max(largest_N, std::abs(point.force_N - point.law_N));
  return largest_N;
}

std::string tableLine(const FrameReport& report, const std::string& experiment, const std::vector<FramePoint>& points) {
  const auto free = freePoints(points), stopped = stoppedPoints(points);
  const std::string at_stops =
      stopped.empty() ? "- | - | -" : fmt::format("{} | {:.1e} | {:.2f}", stopped.size(), frameError(stopped), largestOffN(stopped));
  return fmt::format("| {} {:g}/{:g} mm | {} | {} | {:.1e} | {:.1e} | {:.1e} | {:.2f} | {} |\n", report.specimen.name,
                     report.specimen.minimum_mm, report.specimen.maximum_mm, experiment, free.size(), frameError(free),
                     frameError(pointsOf(free, FrameWay::loading)), frameError(pointsOf(free, FrameWay::unloading)), largestOffN(free),
                     at_stops);
}

std::string csvLine(const std::string& experiment, const FramePoint& p) {
  return fmt::format("{},{},{},{},{},{},{},{}\n", experiment, p.way == FrameWay::loading ? "loading" : "unloading", p.pressure_ratio,
                     p.length_mm, p.force_N, p.law_N, p.long_stop_count, p.short_stop_count);
}

using Number = double (*)(const FramePoint&);

double lengthMm(const FramePoint& p) {
  return p.length_mm;
}
double forceN(const FramePoint& p) {
  return p.force_N;
}
double loadKg(const FramePoint& p) {
  return p.force_N / gravity_m_per_s2;
}
double longStops(const FramePoint& p) {
  return p.long_stop_count;
}

DiagramSeries series(const std::vector<FramePoint>& points, Number x, Number y, const Color& color, SvgMark mark,
                     const std::string& label = "") {
  DiagramSeries result{label, color, {}, {}, mark};
  for (const auto& point : points) {
    result.x.push_back(x(point));
    result.y.push_back(y(point));
  }
  return result;
}

/// Force over length: the law's curves, discs for loading, rings for unloading.
Diagram surface(const std::string& title, const std::vector<FramePoint>& points, const std::vector<std::vector<FramePoint>>& curves) {
  Diagram diagram{title, "length (mm)", "force (N)", {}};
  for (const auto& curve : curves)
    diagram.series.push_back(series(curve, lengthMm, forceN, orderedColor(curve.front().pressure_ratio), SvgMark::none,
                                    fmt::format("p = {:.2f}", curve.front().pressure_ratio)));
  for (const auto& [pressure_ratio, of] : byPressure(points)) {
    diagram.series.push_back(series(pointsOf(of, FrameWay::loading), lengthMm, forceN, orderedColor(pressure_ratio), SvgMark::disc));
    diagram.series.push_back(series(pointsOf(of, FrameWay::unloading), lengthMm, forceN, orderedColor(pressure_ratio), SvgMark::ring));
  }
  return diagram;
}

Diagram overLoad(const std::string& title, const std::string& y_title, const std::vector<FramePoint>& points, Number y) {
  Diagram diagram{title, "load (kg)", y_title, {}};
  for (const auto& [pressure_ratio, of] : byPressure(points)) {
    const Color color = orderedColor(pressure_ratio);
    diagram.series.push_back(series(pointsOf(of, FrameWay::loading), loadKg, y, color, SvgMark::none));
    diagram.series.push_back(series(pointsOf(of, FrameWay::loading), loadKg, y, color, SvgMark::disc));
    diagram.series.push_back(series(pointsOf(of, FrameWay::unloading), loadKg, y, color, SvgMark::ring));
  }
  return diagram;
}

/// Force minus law at a length, interpolated from the points of one pressure; empty far outside of them.
std::optional<double> excessAt(std::vector<FramePoint> points, double length_mm) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.length_mm < b.length_mm; });
  constexpr double margin_ratio = 0.03;
  const double shortest_mm = points.front().length_mm, longest_mm = points.back().length_mm;
  const double margin_mm = margin_ratio * (longest_mm - shortest_mm);
  if (length_mm < shortest_mm - margin_mm || length_mm > longest_mm + margin_mm) return std::nullopt;
  const double l = std::clamp(length_mm, shortest_mm, longest_mm);
  std::size_t next = 1;
  while (next + 1 < points.size() && points[next].length_mm < l) ++next;
  const FramePoint &a = points[next - 1], &b = points[next];
  const double share = b.length_mm > a.length_mm ? (l - a.length_mm) / (b.length_mm - a.length_mm) : 0;
  return (1 - share) * (a.force_N - a.law_N) + share * (b.force_N - b.law_N);
}

/// Force minus law at a length and a pressure, interpolated between the pressures of the points.
std::optional<double> excessAt(const std::map<double, std::vector<FramePoint>>& points, double pressure_ratio, double length_mm) {
  const auto above = points.lower_bound(pressure_ratio);
  if (above == points.end()) return std::nullopt;
  const auto high_N = excessAt(above->second, length_mm);
  if (above->first == pressure_ratio) return high_N;
  if (above == points.begin()) return std::nullopt;
  const auto below = std::prev(above);
  const auto low_N = excessAt(below->second, length_mm);
  if (!low_N || !high_N) return std::nullopt;
  return *low_N + (*high_N - *low_N) * (pressure_ratio - below->first) / (above->first - below->first);
}

/// F(p, l) at the experiment's pressures, over the lengths that the points span.
std::vector<std::vector<FramePoint>> lawCurves(const FrameReport& report, const ForceLaw& law) {
  std::vector<std::vector<FramePoint>> curves;
  for (const auto& [pressure_ratio, of] : byPressure(report.loads)) {
    curves.emplace_back();
    constexpr int sample_count = 100;
    for (int i = 0; i <= sample_count; ++i) {
      FramePoint point;
      point.pressure_ratio = pressure_ratio;
      point.length_mm = report.specimen.minimum_mm + (report.specimen.maximum_mm - report.specimen.minimum_mm) * i / sample_count;
      point.force_N = law.tensionN(pressure_ratio, point.length_mm);
      curves.back().push_back(point);
    }
  }
  return curves;
}

}  // namespace

std::vector<FramePoint> freePoints(const std::vector<FramePoint>& points) {
  return pointsThat(points, [](const auto& point) { return !point.isStopped(); });
}

std::vector<FramePoint> stoppedPoints(const std::vector<FramePoint>& points) {
  return pointsThat(points, [](const auto& point) { return point.isStopped(); });
}

std::vector<FramePoint> pointsOf(const std::vector<FramePoint>& points, FrameWay way) {
  return pointsThat(points, [&](const auto& point) { return point.way == way; });
}

std::string frameTable(const std::vector<FrameReport>& reports) {
  std::string out =
      "| muscle | experiment | points with a free link | relative squared error | loading | unloading | largest N | points with all links "
      "at "
      "stops | relative squared error | largest N |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& report : reports) {
    out += tableLine(report, "loads hung", report.loads);
    out += tableLine(report, "lengths imposed", report.lengths);
  }
  return out;
}

std::string frameCsv(const FrameReport& report) {
  std::string out = "experiment,way,pressure,length_mm,force_N,law_N,long_stop_count,short_stop_count\n";
  for (const auto& point : report.loads) out += csvLine("loads", point);
  for (const auto& point : report.lengths) out += csvLine("lengths", point);
  return out;
}

std::unique_ptr<ForceLaw> frameLaw(const FrameSpecimen& specimen, const Parameters& parameters) {
  Parameters declared = parameters;
  // The shortest length of the muscle is that of its links.
  const double link_mm = 2 * MuscleSettings(declared).bead_radius_mm;
  return makeForceLaw(declared, std::max(2.0, std::round(specimen.minimum_mm / link_mm)) * link_mm, specimen.maximum_mm);
}

std::string frameFigureSvg(const FrameReport& report, const ForceLaw& law) {
  const auto law_curves = lawCurves(report, law);
  return diagramsSvg(fmt::format("Load frame, {} muscle ({:g}/{:g} mm): curves F(p, l), discs loading, rings unloading",
                                 report.specimen.name, report.specimen.minimum_mm, report.specimen.maximum_mm),
                     {surface("loads hung", report.loads, law_curves), surface("lengths imposed", report.lengths, law_curves),
                      overLoad("loads hung: length", "length (mm)", report.loads, lengthMm),
                      overLoad("loads hung: links at their long stops", "links", report.loads, longStops)},
                     2);
}

DataComparison compareWithData(const std::vector<FramePoint>& lengths, const ForceLaw& law, const StaticPoints& measured) {
  const auto loading = byPressure(pointsOf(lengths, FrameWay::loading)), unloading = byPressure(pointsOf(lengths, FrameWay::unloading));
  DataComparison comparison;
  double off = 0, total = 0;
  for (const auto& point : measured.points) {
    const auto one_N = excessAt(loading, point.pressure_ratio, point.length_mm);
    if (!one_N || point.censored) {
      ++comparison.outside_count;
      continue;
    }
    // The longest length is the turning point and has one direction only.
    const double other_N = excessAt(unloading, point.pressure_ratio, point.length_mm).value_or(*one_N);
    ++comparison.compared_count;
    off += std::pow(law.tensionN(point.pressure_ratio, point.length_mm) + (*one_N + other_N) / 2 - point.force_N, 2);
    total += point.force_N * point.force_N;
  }
  comparison.relative_squared_error = total > 0 ? off / total : 0;
  return comparison;
}

}  // namespace musclesim
