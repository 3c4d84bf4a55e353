#include "plot.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace musclesim {

namespace {

ImU32 packed(const Color& color, float alpha = 1) {
  return ImGui::ColorConvertFloat4ToU32(
      {static_cast<float>(color.red), static_cast<float>(color.green), static_cast<float>(color.blue), alpha});
}

/// The smallest number of the form 1, 2 or 5 times a power of ten that is at least a width.
double roundUp(double width) {
  const double power = std::pow(10, std::floor(std::log10(width)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= width) return factor * power;
  return 10 * power;
}

std::pair<double, double> rangeOf(const std::vector<PlotCurve>& curves, const History& history) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const PlotCurve& curve : curves) {
    for (const auto& sample : history.samples()) {
      const auto value = curve.value(sample);
      if (!value || !std::isfinite(*value)) continue;
      low = std::min(low, *value);
      high = std::max(high, *value);
    }
  }
  if (!(low <= high)) return {0, 1};
  const double unit = roundUp(std::max({(high - low) / 4, std::abs(high) * 1e-2, 1e-3}));
  return {std::floor(low / unit) * unit, (std::floor(high / unit) + 1) * unit};
}

void drawCurve(const PlotCurve& curve, const History& history, const ImVec2& corner, const ImVec2& size, std::pair<double, double> range) {
  const double end_s = history.samples().back().state.time_s;
  std::vector<ImVec2> points;
  for (const auto& sample : history.samples()) {
    const auto value = curve.value(sample);
    if (!value || !std::isfinite(*value)) continue;
    const double x = 1 - (end_s - sample.state.time_s) / History::duration_s;
    const double y = std::clamp((*value - range.first) / (range.second - range.first), 0.0, 1.0);
    points.emplace_back(corner.x + size.x * static_cast<float>(x), corner.y + size.y * static_cast<float>(1 - y));
  }
  ImGui::GetWindowDrawList()->AddPolyline(points.data(), static_cast<int>(points.size()), packed(curve.color), 0, 1.6F);
}

/// Writes the title, then the names of the curves in their colours with their latest values.
void drawTitle(const std::string& title, const std::vector<PlotCurve>& curves, const History& history) {
  ImGui::TextUnformatted(title.c_str());
  for (const PlotCurve& curve : curves) {
    const auto latest = history.samples().empty() ? std::nullopt : curve.value(history.samples().back());
    const std::string text = curve.name + (latest ? fmt::format(" {:.3g}", *latest) : "");
    ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(packed(curve.color)), "%s", text.c_str());
  }
}

/// Writes the ends of the range where they are; in a low plot, in which they would overlap, beside each other.
void drawRange(const ImVec2& corner, const ImVec2& far_corner, std::pair<double, double> range) {
  const ImU32 grey = IM_COL32(130, 135, 142, 255);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float font = ImGui::GetFontSize(), height = far_corner.y - corner.y;
  if (height < 2 * font + 2) {
    const std::string both = fmt::format("{:g} .. {:g}", range.first, range.second);
    return list->AddText({corner.x + 4, corner.y + (height - font) / 2}, grey, both.c_str());
  }
  list->AddText({corner.x + 4, corner.y + 1}, grey, fmt::format("{:g}", range.second).c_str());
  list->AddText({corner.x + 4, far_corner.y - font - 1}, grey, fmt::format("{:g}", range.first).c_str());
}

}  // namespace

void drawPlot(const std::string& title, const std::vector<PlotCurve>& curves, const History& history, float height_px,
              std::optional<std::pair<double, double>> fixed_range) {
  drawTitle(title, curves, history);
  const auto range = fixed_range.value_or(rangeOf(curves, history));
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 corner = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, height_px);
  const ImVec2 far_corner(corner.x + size.x, corner.y + size.y);
  list->AddRectFilled(corner, far_corner, IM_COL32(255, 255, 255, 255), 3);
  const float middle = corner.y + size.y / 2;
  list->AddLine({corner.x, middle}, {far_corner.x, middle}, IM_COL32(225, 228, 232, 255));
  list->PushClipRect(corner, far_corner, true);
  if (!history.samples().empty())
    for (const PlotCurve& curve : curves) drawCurve(curve, history, corner, size, range);
  list->PopClipRect();
  list->AddRect(corner, far_corner, IM_COL32(190, 195, 202, 255), 3);
  drawRange(corner, far_corner, range);
  ImGui::Dummy(size);
}

}  // namespace musclesim
