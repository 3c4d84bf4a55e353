#include "figure_parts.h"

namespace musclesim {

using namespace figure_style;

namespace {

constexpr double sample_length = 16, text_gap = 5, entry_gap = 14;
constexpr double letter_width_ratio = 0.52;  ///< mean width of a letter over the font's size

double entryWidth(const LegendEntry& entry) {
  return sample_length + text_gap + letter_width_ratio * label_size * static_cast<double>(entry.label.size()) + entry_gap;
}

}  // namespace

std::vector<std::vector<LegendEntry>> legendRows(const std::vector<LegendEntry>& entries, double width) {
  std::vector<std::vector<LegendEntry>> rows;
  double used = 0;
  for (const auto& entry : entries) {
    if (rows.empty() || used + entryWidth(entry) > width + entry_gap) {
      rows.emplace_back();
      used = 0;
    }
    rows.back().push_back(entry);
    used += entryWidth(entry);
  }
  return rows;
}

void drawLegend(Svg& svg, const std::vector<std::vector<LegendEntry>>& rows, double left, double top) {
  for (std::size_t row = 0; row < rows.size(); ++row) {
    double x = left;
    const double y = top + legend_height * (static_cast<double>(row) + 0.5);
    for (const auto& entry : rows[row]) {
      if (entry.mark == SvgMark::none)
        svg.sample({x, y - 4}, sample_length, entry.color, 2.4);
      else
        svg.mark({x + sample_length / 2, y - 4}, entry.mark, entry.color, "");
      svg.text({x + sample_length + text_gap, y}, entry.label, {label_size, SvgAnchor::start, text_color, false, false});
      x += entryWidth(entry);
    }
  }
}

void drawLowerAxis(Svg& svg, const Axis& axis, const SvgBox& box, const std::string& title) {
  for (const double tick : axis.ticks()) {
    const double x = axis.pixel(tick);
    svg.line({x, box.top}, {x, box.bottom()}, grid_color, 0.8);
    svg.line({x, box.bottom()}, {x, box.bottom() + 4}, frame_color, 1);
    if (!title.empty()) svg.text({x, box.bottom() + 18}, axis.label(tick), {label_size, SvgAnchor::middle, text_color, false, false});
  }
  if (!title.empty())
    svg.text({box.left + box.width / 2, box.bottom() + 36}, title, {axis_title_size, SvgAnchor::middle, text_color, false, false});
}

void drawLeftAxis(Svg& svg, const Axis& axis, const SvgBox& box, const std::string& title, double title_x) {
  for (const double tick : axis.ticks()) {
    const double y = axis.pixel(tick);
    svg.line({box.left, y}, {box.right(), y}, grid_color, 0.8);
    svg.line({box.left - 4, y}, {box.left, y}, frame_color, 1);
    svg.text({box.left - 8, y + 4}, axis.label(tick), {label_size, SvgAnchor::end, text_color, false, false});
  }
  svg.text({title_x, box.top + box.height / 2}, title, {axis_title_size, SvgAnchor::middle, text_color, false, true});
}

}  // namespace musclesim
