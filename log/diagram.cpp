#include "diagram.h"

#include <algorithm>
#include <cmath>

#include "curve.h"
#include "figure_parts.h"

namespace musclesim {

using namespace figure_style;

namespace {

constexpr double cell_width = 520;
const Color band_color{0.80, 0.87, 0.95, ""};
constexpr double diagram_left_margin = 84, diagram_right_margin = 22, diagram_top_margin = 34, diagram_bottom_margin = 50,
                 heading_height = 44;

Extent extentOf(const Diagram& diagram, const std::vector<double> DiagramSeries::*numbers) {
  Extent extent;
  for (const auto& series : diagram.series) extent.add(series.*numbers);
  return extent;
}

Extent heightOf(const Diagram& diagram) {
  Extent extent = extentOf(diagram, &DiagramSeries::y);
  if (diagram.band)
    for (const double side : {-1.0, 1.0}) extent.add(side * diagram.band->half_width);
  return extent;
}

void drawBand(Svg& svg, const DiagramBand& band, const Axis& y_axis, const SvgBox& box) {
  const double top = y_axis.pixel(band.half_width), bottom = y_axis.pixel(-band.half_width);
  svg.fill({box.left, top, box.width, bottom - top}, hexColor(band_color));
}

void drawSeries(Svg& svg, const DiagramSeries& series, const Axis& x_axis, const Axis& y_axis, const SvgBox& clip) {
  if (series.mark == SvgMark::none) {
    svg.curve(curvePieces(series.x, series.y, x_axis, y_axis, Between::straight), series.color, series.width, clip, series.label);
    return;
  }
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i)
    if (std::isfinite(series.y[i]))
      svg.mark({x_axis.pixel(series.x[i]), y_axis.pixel(series.y[i])}, series.mark, series.color, series.label);
}

void drawDiagram(Svg& svg, const Diagram& diagram, double left, double top, double cell_height) {
  const SvgBox box{left + diagram_left_margin, top + diagram_top_margin, cell_width - diagram_left_margin - diagram_right_margin,
                   cell_height - diagram_top_margin - diagram_bottom_margin};
  const Axis x_axis(extentOf(diagram, &DiagramSeries::x), box.left, box.right(), 8, true);
  constexpr double pixels_per_tick = 39;
  const Axis y_axis(heightOf(diagram), box.bottom(), box.top, static_cast<int>(box.height / pixels_per_tick), true);
  if (diagram.band) drawBand(svg, *diagram.band, y_axis, box);
  svg.text({box.left, box.top - 8}, diagram.title, {axis_title_size, SvgAnchor::start, title_color, true, false});
  drawLowerAxis(svg, x_axis, box, diagram.x_title);
  drawLeftAxis(svg, y_axis, box, diagram.y_title, left + 16);
  for (const auto& series : diagram.series)
    drawSeries(svg, series, x_axis, y_axis, {box.left - 1, box.top - 1, box.width + 2, box.height + 2});
  svg.frame(box, frame_color);
}

/// All labels without repetition, in the order of the diagrams.
std::vector<LegendEntry> legendOf(const std::vector<Diagram>& diagrams) {
  std::vector<LegendEntry> entries;
  const auto add = [&](const LegendEntry& entry) {
    const bool is_known = std::ranges::find(entries, entry.label, &LegendEntry::label) != entries.end();
    if (!entry.label.empty() && !is_known) entries.push_back(entry);
  };
  for (const auto& diagram : diagrams) {
    for (const auto& series : diagram.series) add({series.label, series.color, series.mark});
    if (diagram.band) add({diagram.band->label, band_color});
  }
  return entries;
}

}  // namespace

Color orderedColor(double ratio) {
  const Color stops[] = {
      {0.10, 0.30, 0.75, ""}, {0.00, 0.58, 0.55, ""}, {0.45, 0.60, 0.00, ""}, {0.90, 0.50, 0.00, ""}, {0.80, 0.10, 0.20, ""}};
  const double along = std::clamp(ratio, 0.0, 1.0) * 4;
  const auto first = std::min(static_cast<std::size_t>(along), std::size_t{3});
  const double to = along - static_cast<double>(first);
  const Color &a = stops[first], &b = stops[first + 1];
  return {a.red + to * (b.red - a.red), a.green + to * (b.green - a.green), a.blue + to * (b.blue - a.blue), ""};
}

std::string diagramsSvg(const std::string& title, const std::vector<Diagram>& diagrams, int column_count, double cell_height) {
  const auto columns = static_cast<std::size_t>(std::max(column_count, 1));
  const std::size_t row_count = (diagrams.size() + columns - 1) / columns;
  const double width = cell_width * static_cast<double>(columns);
  const auto legend = legendRows(legendOf(diagrams), width - diagram_left_margin - diagram_right_margin);
  const double diagrams_top = heading_height + legend_height * static_cast<double>(legend.size());
  Svg svg(width, diagrams_top + cell_height * static_cast<double>(row_count), title);
  svg.text({diagram_left_margin, 28}, title, {title_size, SvgAnchor::start, title_color, true, false});
  drawLegend(svg, legend, diagram_left_margin, heading_height);
  for (std::size_t i = 0; i < diagrams.size(); ++i) {
    const std::size_t column = i % columns, row = i / columns;
    drawDiagram(svg, diagrams[i], cell_width * static_cast<double>(column), diagrams_top + cell_height * static_cast<double>(row),
                cell_height);
  }
  return svg.document();
}

}  // namespace musclesim
