#include "musclesim/log/figure.h"

#include <fmt/format.h>

#include <algorithm>

#include "axis.h"
#include "curve.h"
#include "figure_panels.h"
#include "figure_parts.h"
#include "musclesim/base/file.h"
#include "svg.h"

namespace musclesim {

using namespace figure_style;

namespace {

constexpr double figure_width = 960, figure_height = 640;
constexpr double left_margin = 78, right_margin = 76, top_margin = 46;
constexpr double panel_gap = 16, time_axis_height = 44, bottom_margin = 10;
constexpr double stacked_height = 190;      ///< of a panel in a figure of chosen signals
constexpr double upper_share_ratio = 0.55;  ///< share of the upper panel in the height of both

std::vector<LegendEntry> legendEntries(const std::vector<Curve>& curves) {
  std::vector<LegendEntry> entries;
  for (const auto& curve : curves) entries.push_back({curve.label, curve.color});
  return entries;
}

/// Draws one recording's panels.
class RunFigure {
 public:
  RunFigure(const Recording& recording, const std::string& title, double height = figure_height)
      : recording_(recording), svg_(figure_width, height, title) {
    svg_.text({left_margin, 28}, title, {title_size, SvgAnchor::start, "#111111", true, false});
    for (const double time_s : {recording.time_s.front(), recording.time_s.back()}) time_extent_.add(time_s);
  }

  std::string draw(const Panel& upper, const Panel& lower);
  /// Panels one below the other, each under its legend.
  std::string draw(const std::vector<Panel>& panels);

 private:
  Axis timeAxis(const SvgBox& box) const { return {time_extent_, box.left, box.right(), 10, false}; }
  void drawPanel(const Panel& panel, const SvgBox& box, bool with_time_labels);
  void drawCurves(const std::vector<Curve>& curves, const SvgBox& box, const Axis& axis);
  void drawRightAxis(const Axis& axis, const Panel& panel, const SvgBox& box);

  const Recording& recording_;
  Svg svg_;
  Extent time_extent_;
};

Axis valueAxis(const std::vector<Curve>& curves, const SvgBox& box, bool from_zero, bool is_fraction) {
  Extent extent;
  for (const auto& curve : curves) extent.add(curve.signal->values);
  if (from_zero || is_fraction) extent.add(0);
  if (is_fraction) extent.add(1);
  constexpr double pixels_per_tick = 40;
  const int tick_count = std::max(2, static_cast<int>(box.height / pixels_per_tick));
  return {extent, box.bottom(), box.top, tick_count, true};
}

std::string RunFigure::draw(const Panel& upper, const Panel& lower) {
  const double width = figure_width - left_margin - right_margin;
  std::vector<Curve> upper_entries = upper.curves;
  upper_entries.insert(upper_entries.end(), upper.right_curves.begin(), upper.right_curves.end());
  const auto upper_legend = legendRows(legendEntries(upper_entries), width);
  const auto lower_legend = legendRows(legendEntries(lower.curves), width);
  const double legend_total = legend_height * static_cast<double>(upper_legend.size() + lower_legend.size());
  const double panels_height =
      figure_height - top_margin - legend_total - time_axis_height - bottom_margin - (upper.empty() ? 0 : panel_gap);
  const double upper_height = upper.empty() ? 0 : upper_share_ratio * panels_height;
  double top = top_margin;
  if (!upper.empty()) {
    drawLegend(svg_, upper_legend, left_margin, top);
    top += legend_height * static_cast<double>(upper_legend.size());
    drawPanel(upper, {left_margin, top, width, upper_height}, false);
    top += upper_height + panel_gap;
  }
  const SvgBox lower_box{left_margin, top, width, panels_height - upper_height};
  drawPanel(lower, lower_box, true);
  drawLegend(svg_, lower_legend, left_margin, lower_box.bottom() + time_axis_height);
  return svg_.document();
}

std::string RunFigure::draw(const std::vector<Panel>& panels) {
  const double width = figure_width - left_margin - right_margin;
  double top = top_margin;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const auto legend = legendRows(legendEntries(panels[i].curves), width);
    drawLegend(svg_, legend, left_margin, top);
    top += legend_height * static_cast<double>(legend.size());
    drawPanel(panels[i], {left_margin, top, width, stacked_height}, i + 1 == panels.size());
    top += stacked_height + panel_gap;
  }
  return svg_.document();
}

/// The height of a figure of such panels.
double stackedHeight(const std::vector<Panel>& panels) {
  const double width = figure_width - left_margin - right_margin;
  double height = top_margin + time_axis_height + bottom_margin;
  for (const Panel& panel : panels)
    height += stacked_height + panel_gap + legend_height * static_cast<double>(legendRows(legendEntries(panel.curves), width).size());
  return height;
}

void RunFigure::drawPanel(const Panel& panel, const SvgBox& box, bool with_time_labels) {
  const Axis axis = valueAxis(panel.curves, box, false, panel.is_fraction);
  const Axis right_axis = valueAxis(panel.right_curves, box, true, false);
  drawLowerAxis(svg_, timeAxis(box), box, with_time_labels ? "time (s)" : "");
  if (!panel.curves.empty()) drawLeftAxis(svg_, axis, box, panel.axis_title, 20);
  if (!panel.right_curves.empty()) drawRightAxis(right_axis, panel, box);
  drawCurves(panel.right_curves, box, right_axis);
  drawCurves(panel.curves, box, axis);
  svg_.frame(box, frame_color);
}

void RunFigure::drawCurves(const std::vector<Curve>& curves, const SvgBox& box, const Axis& axis) {
  // Room for the line width, so that a curve along the frame is not cut in half.
  const SvgBox clip{box.left - 1, box.top - 1, box.width + 2, box.height + 2};
  // The curve that comes first in the legend is drawn last, on top.
  for (auto curve = curves.rbegin(); curve != curves.rend(); ++curve)
    svg_.curve(curvePieces(recording_.time_s, curve->signal->values, timeAxis(box), axis, curve->between), curve->color, curve->width, clip,
               fmt::format("{} ({})", curve->label, curve->signal->name));
}

void RunFigure::drawRightAxis(const Axis& axis, const Panel& panel, const SvgBox& box) {
  const std::string color = hexColor(panel.right_curves.front().color);
  for (const double tick : axis.ticks()) {
    const double y = axis.pixel(tick);
    svg_.line({box.right(), y}, {box.right() + 4, y}, color, 1);
    svg_.text({box.right() + 8, y + 4}, axis.label(tick), {label_size, SvgAnchor::start, color, false, false});
  }
  svg_.text({figure_width - 14, box.top + box.height / 2}, panel.right_axis_title,
            {axis_title_size, SvgAnchor::middle, color, false, true});
}

}  // namespace

std::string runFigureSvg(const Recording& recording, const std::vector<Color>& muscle_colors, const std::string& title) {
  if (recording.time_s.empty()) return Svg(figure_width, figure_height, title).document();
  return RunFigure(recording, title).draw(upperPanel(recording, muscle_colors), lowerPanel(recording, muscle_colors));
}

std::string signalsFigureSvg(const Recording& recording, const std::vector<std::string>& signals, const std::vector<Color>& muscle_colors,
                             const std::string& title) {
  const std::vector<Panel> panels = signalPanels(recording, signals, muscle_colors);
  return RunFigure(recording, title, stackedHeight(panels)).draw(panels);
}

void writeRunFigure(const Recording& recording, const std::vector<Color>& muscle_colors, const std::string& title,
                    const std::string& svg_file) {
  replaceFile(svg_file, runFigureSvg(recording, muscle_colors, title));
}

}  // namespace musclesim
