#include "fit_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagram.h"
#include "point_groups.h"

namespace musclesim {

namespace {

constexpr std::size_t most_curves = 10;

std::string pressureLabel(double pressure_ratio, const StaticPoints& points) {
  if (points.full_scale_kPa) return fmt::format("{:.0f} kPa", pressure_ratio * *points.full_scale_kPa);
  return fmt::format("p = {:.3g}", pressure_ratio);
}

/// At most `most_curves` groups, evenly spaced, including the lowest and the highest.
std::vector<PointGroup> shownGroups(const StaticPoints& points) {
  const auto all = groupByPressure(points.points);
  if (all.size() <= most_curves) return all;
  std::vector<PointGroup> shown;
  for (std::size_t i = 0; i < most_curves; ++i) shown.push_back(all[i * (all.size() - 1) / (most_curves - 1)]);
  return shown;
}

DiagramSeries lawCurve(const ForceLaw& law, double pressure_ratio, const StaticPoints& points) {
  constexpr int sample_count = 120;
  DiagramSeries curve;
  const double shortest_mm = points.shortestMm(), longest_mm = points.longestMm();
  for (int i = 0; i <= sample_count; ++i) {
    const double length_mm = shortest_mm + (longest_mm - shortest_mm) * i / sample_count;
    curve.x.push_back(length_mm);
    curve.y.push_back(law.tensionN(pressure_ratio, length_mm));
  }
  return curve;
}

void addPoint(DiagramSeries& series, double x, double y) {
  series.x.push_back(x);
  series.y.push_back(y);
}

/// The points of one pressure as three series: measured, censored, outliers. Labels appear as tooltips only.
void addPoints(Diagram& forces, Diagram& residuals, const PointGroup& group, const ForceLaw& law, const StaticPoints& points,
               const Color& color) {
  DiagramSeries measured{"", color, {}, {}, SvgMark::disc}, censored{"", color, {}, {}, SvgMark::ring};
  DiagramSeries outliers{"", color, {}, {}, SvgMark::cross}, off{"", color, {}, {}, SvgMark::disc};
  for (const std::size_t i : group.of) {
    const StaticPoint& point = points.points[i];
    addPoint(point.outlier ? outliers : point.censored ? censored : measured, point.length_mm, point.force_N);
    if (!point.outlier && !point.censored)
      addPoint(off, point.length_mm, law.tensionN(point.pressure_ratio, point.length_mm) - point.force_N);
  }
  for (auto* series : {&measured, &censored, &outliers})
    if (!series->x.empty()) forces.series.push_back(*series);
  if (!off.x.empty()) residuals.series.push_back(off);
}

}  // namespace

std::string fitFigureSvg(const LawReport& report, const StaticPoints& points) {
  const auto law = report.law();
  Diagram forces{"measured points and fitted law", "length (mm)", "force (N)", {}};
  Diagram residuals{"model minus measurement", "length (mm)", "force (N)", {}};
  const auto groups = shownGroups(points);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const PointGroup& group = groups[i];
    const Color color = orderedColor(static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(groups.size(), 2) - 1));
    DiagramSeries curve = lawCurve(*law, group.value, points);
    curve.label = pressureLabel(group.value, points);
    curve.color = color;
    forces.series.push_back(curve);
    addPoints(forces, residuals, group, *law, points, color);
  }
  DiagramSeries zero;
  zero.color = {0.3, 0.3, 0.3, ""};
  zero.x = {points.shortestMm(), points.longestMm()};
  zero.y = {0, 0};
  zero.width = 0.8;
  residuals.series.push_back(std::move(zero));
  return diagramsSvg(fmt::format("{}: relative squared error {:.2e}", report.model->name(), report.fit.error.relativeSquaredError()),
                     {forces, residuals}, 2);
}

}  // namespace musclesim
