/// Parts that all figures share: axes, grid, legend.
#pragma once

#include <string>
#include <vector>

#include "axis.h"
#include "svg.h"

namespace musclesim {

namespace figure_style {
inline constexpr double label_size = 12, axis_title_size = 13, title_size = 16, legend_height = 22;
inline const std::string grid_color = "#e4e4e4", frame_color = "#555555", text_color = "#333333", title_color = "#111111";
}  // namespace figure_style

/// How a legend shows a curve: by a piece of line or by a mark.
struct LegendEntry {
  std::string label;
  Color color;
  SvgMark mark = SvgMark::none;
};

/// The entries of a legend, split into rows no wider than `width`.
std::vector<std::vector<LegendEntry>> legendRows(const std::vector<LegendEntry>& entries, double width);
void drawLegend(Svg& svg, const std::vector<std::vector<LegendEntry>>& rows, double left, double top);

/// Draws grid lines and ticks of the axis below a box; also labels and the title, unless the title is empty.
void drawLowerAxis(Svg& svg, const Axis& axis, const SvgBox& box, const std::string& title);
/// Draws grid lines, ticks, labels and title of the axis left of a box; the title is at `title_x`.
void drawLeftAxis(Svg& svg, const Axis& axis, const SvgBox& box, const std::string& title, double title_x);

}  // namespace musclesim
