#include "musclesim/log/figure.h"

#include <fmt/format.h>

#include <algorithm>

#include "axis.h"
#include "curve.h"
#include "figure_panels.h"
#include "musclesim/log/file.h"
#include "svg.h"

namespace musclesim {

namespace {

constexpr double figure_width = 960, figure_height = 640;
constexpr double left_margin = 78, right_margin = 76, top_margin = 46;
constexpr double legend_height = 22, panel_gap = 16, time_axis_height = 44, bottom_margin = 10;
constexpr double upper_share_ratio = 0.55;  ///< of the height of both panels
constexpr double label_size = 12, axis_title_size = 13, title_size = 16;
constexpr double legend_sample_length = 16, legend_text_gap = 5, legend_gap = 14;
constexpr double letter_width_ratio = 0.52;  ///< mean width of a letter over the font's size
const std::string grid_color = "#e4e4e4", frame_color = "#555555", text_color = "#333333";

double textWidth(const std::string& words, double size) {
  return letter_width_ratio * size * static_cast<double>(words.size());
}

double legendEntryWidth(const Curve& curve) {
  return legend_sample_length + legend_text_gap + textWidth(curve.label, label_size) + legend_gap;
}

/// The entries of a legend, row by row, none wider than the panel.
std::vector<std::vector<Curve>> legendRows(const std::vector<Curve>& curves, double width) {
  std::vector<std::vector<Curve>> rows;
  double used = 0;
  for (const auto& curve : curves) {
    if (rows.empty() || used + legendEntryWidth(curve) > width + legend_gap) {
      rows.emplace_back();
      used = 0;
    }
    rows.back().push_back(curve);
    used += legendEntryWidth(curve);
  }
  return rows;
}

/// Draws one recording's panels.
class RunFigure {
 public:
  RunFigure(const Recording& recording, const std::string& title) : recording_(recording), svg_(figure_width, figure_height, title) {
    svg_.text({left_margin, 28}, title, {title_size, SvgAnchor::start, "#111111", true, false});
    for (const double time_s : {recording.time_s.front(), recording.time_s.back()}) time_extent_.add(time_s);
  }

  std::string draw(const Panel& upper, const Panel& lower);

 private:
  Axis timeAxis(const SvgBox& box) const { return {time_extent_, box.left, box.right(), 10, false}; }
  void drawPanel(const Panel& panel, const SvgBox& box, bool with_time_labels);
  void drawCurves(const std::vector<Curve>& curves, const SvgBox& box, const Axis& axis);
  void drawTimeAxis(const SvgBox& box, bool with_labels);
  void drawValueAxis(const Axis& axis, const std::string& title, const SvgBox& box);
  void drawRightAxis(const Axis& axis, const Panel& panel, const SvgBox& box);
  void drawLegend(const std::vector<std::vector<Curve>>& rows, double left, double top);

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
  const auto upper_legend = legendRows(upper_entries, width), lower_legend = legendRows(lower.curves, width);
  const double legend_total = legend_height * static_cast<double>(upper_legend.size() + lower_legend.size());
  const double panels_height =
      figure_height - top_margin - legend_total - time_axis_height - bottom_margin - (upper.empty() ? 0 : panel_gap);
  const double upper_height = upper.empty() ? 0 : upper_share_ratio * panels_height;
  double top = top_margin;
  if (!upper.empty()) {
    drawLegend(upper_legend, left_margin, top);
    top += legend_height * static_cast<double>(upper_legend.size());
    drawPanel(upper, {left_margin, top, width, upper_height}, false);
    top += upper_height + panel_gap;
  }
  const SvgBox lower_box{left_margin, top, width, panels_height - upper_height};
  drawPanel(lower, lower_box, true);
  drawLegend(lower_legend, left_margin, lower_box.bottom() + time_axis_height);
  return svg_.document();
}

void RunFigure::drawPanel(const Panel& panel, const SvgBox& box, bool with_time_labels) {
  const Axis axis = valueAxis(panel.curves, box, false, panel.is_fraction);
  const Axis right_axis = valueAxis(panel.right_curves, box, true, false);
  drawTimeAxis(box, with_time_labels);
  if (!panel.curves.empty()) drawValueAxis(axis, panel.axis_title, box);
  if (!panel.right_curves.empty()) drawRightAxis(right_axis, panel, box);
  drawCurves(panel.right_curves, box, right_axis);
  drawCurves(panel.curves, box, axis);
  svg_.frame(box, frame_color);
}

void RunFigure::drawCurves(const std::vector<Curve>& curves, const SvgBox& box, const Axis& axis) {
  // A curve along the frame shall not be cut in half.
  const SvgBox clip{box.left - 1, box.top - 1, box.width + 2, box.height + 2};
  // The first of the legend is drawn last, on top.
  for (auto curve = curves.rbegin(); curve != curves.rend(); ++curve)
    svg_.curve(curvePieces(recording_.time_s, curve->signal->values, timeAxis(box), axis, curve->between), curve->color, curve->width, clip,
               fmt::format("{} ({})", curve->label, curve->signal->name));
}

void RunFigure::drawTimeAxis(const SvgBox& box, bool with_labels) {
  const Axis axis = timeAxis(box);
  for (const double tick : axis.ticks()) {
    const double x = axis.pixel(tick);
    svg_.line({x, box.top}, {x, box.bottom()}, grid_color, 0.8);
    svg_.line({x, box.bottom()}, {x, box.bottom() + 4}, frame_color, 1);
    if (with_labels) svg_.text({x, box.bottom() + 18}, axis.label(tick), {label_size, SvgAnchor::middle, text_color, false, false});
  }
  if (with_labels)
    svg_.text({box.left + box.width / 2, box.bottom() + 36}, "time (s)", {axis_title_size, SvgAnchor::middle, text_color, false, false});
}

void RunFigure::drawValueAxis(const Axis& axis, const std::string& title, const SvgBox& box) {
  for (const double tick : axis.ticks()) {
    const double y = axis.pixel(tick);
    svg_.line({box.left, y}, {box.right(), y}, grid_color, 0.8);
    svg_.line({box.left - 4, y}, {box.left, y}, frame_color, 1);
    svg_.text({box.left - 8, y + 4}, axis.label(tick), {label_size, SvgAnchor::end, text_color, false, false});
  }
  svg_.text({20, box.top + box.height / 2}, title, {axis_title_size, SvgAnchor::middle, text_color, false, true});
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

void RunFigure::drawLegend(const std::vector<std::vector<Curve>>& rows, double left, double top) {
  for (std::size_t row = 0; row < rows.size(); ++row) {
    double x = left;
    const double y = top + legend_height * (static_cast<double>(row) + 0.5);
    for (const auto& curve : rows[row]) {
      svg_.sample({x, y - 4}, legend_sample_length, curve.color, 2.4);
      svg_.text({x + legend_sample_length + legend_text_gap, y}, curve.label, {label_size, SvgAnchor::start, text_color, false, false});
      x += legendEntryWidth(curve);
    }
  }
}

}  // namespace

std::string runFigureSvg(const Recording& recording, const std::vector<Color>& muscle_colors, const std::string& title) {
  if (recording.time_s.empty()) return Svg(figure_width, figure_height, title).document();
  return RunFigure(recording, title).draw(upperPanel(recording, muscle_colors), lowerPanel(recording, muscle_colors));
}

void writeRunFigure(const Recording& recording, const std::vector<Color>& muscle_colors, const std::string& title,
                    const std::string& svg_file) {
  replaceFile(svg_file, runFigureSvg(recording, muscle_colors, title));
}

}  // namespace musclesim
