#include "gap_plot.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace musclesim {

namespace {

constexpr ImU32 measured_ink = IM_COL32(26, 107, 242, 255), simulated_ink = IM_COL32(45, 45, 52, 255),
                residual_ink = IM_COL32(178, 90, 10, 255), band_ink = IM_COL32(204, 222, 242, 255),
                frame_ink = IM_COL32(190, 195, 202, 255), number_ink = IM_COL32(130, 135, 142, 255);

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// With a margin, and wide enough to draw something.
  Range widened() const {
    if (!(low <= high)) return {0, 1};
    const double room = std::max({0.05 * (high - low), 1e-3 * std::abs(high), 1e-6});
    return {low - room, high + room};
  }
};

/// A frame at ImGui's cursor with axes of time and value.
class Diagram2d {
 public:
  Diagram2d(const Player& player, const Range& range, float height_px)
      : player_(player),
        range_(range),
        corner_(ImGui::GetCursorScreenPos()),
        size_(ImGui::GetContentRegionAvail().x, height_px),
        list_(ImGui::GetWindowDrawList()) {
    list_->AddRectFilled(corner_, farCorner(), IM_COL32(255, 255, 255, 255), 3);
  }

  void band(double half_width) {
    list_->PushClipRect(corner_, farCorner(), true);
    list_->AddRectFilled({corner_.x, yOf(half_width)}, {farCorner().x, yOf(-half_width)}, band_ink);
    list_->PopClipRect();
  }

  /// Of the rows in one column of pixels only the least and the greatest value are drawn, in their order.
  void curve(const std::vector<double>& time_s, const std::vector<double>& values, ImU32 paint, float width) {
    std::vector<ImVec2> points;
    float column = -1;
    Range in_column;
    bool rises = true;  // whether the greatest value came last
    const auto flush = [&] {
      if (!(in_column.low <= in_column.high)) return;
      points.emplace_back(column, yOf(rises ? in_column.low : in_column.high));
      if (in_column.high > in_column.low) points.emplace_back(column, yOf(rises ? in_column.high : in_column.low));
      in_column = {};
    };
    for (std::size_t row = 0; row < std::min(time_s.size(), values.size()); ++row) {
      const float x = std::floor(xOf(time_s[row]));
      if (x != column) flush();
      column = x;
      if (values[row] >= in_column.high) rises = true;
      if (values[row] <= in_column.low) rises = false;
      in_column.add(values[row]);
    }
    flush();
    list_->AddPolyline(points.data(), static_cast<int>(points.size()), paint, 0, width);
  }

  void finish() {
    const float now = xOf(player_.timeS());
    list_->AddLine({now, corner_.y}, {now, farCorner().y}, IM_COL32(0, 0, 0, 160), 1);
    list_->AddRect(corner_, farCorner(), frame_ink, 3);
    list_->AddText({corner_.x + 4, corner_.y + 1}, number_ink, fmt::format("{:.4g}", range_.high).c_str());
    list_->AddText({corner_.x + 4, farCorner().y - ImGui::GetFontSize() - 1}, number_ink, fmt::format("{:.4g}", range_.low).c_str());
    ImGui::Dummy(size_);
  }

 private:
  ImVec2 farCorner() const { return {corner_.x + size_.x, corner_.y + size_.y}; }
  float xOf(double time_s) const {
    const double duration_s = player_.endS() - player_.beginS();
    return corner_.x + size_.x * static_cast<float>(duration_s > 0 ? (time_s - player_.beginS()) / duration_s : 0);
  }
  float yOf(double value) const {
    const double share = std::clamp((value - range_.low) / (range_.high - range_.low), -1.0, 2.0);
    return corner_.y + size_.y * static_cast<float>(1 - share);
  }

  const Player& player_;
  Range range_;
  ImVec2 corner_, size_;
  ImDrawList* list_;
};

void coloredWords(const char* name, const std::vector<double>& values, std::size_t row, ImU32 paint) {
  const bool is_there = row < values.size() && std::isfinite(values[row]);
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(paint), "%s %s", name, is_there ? fmt::format("{:.4g}", values[row]).c_str() : "-");
}

}  // namespace

void drawGapPlots(const Player& player, float height_px) {
  const ReplayGap* gap = player.gap();
  if (!gap) return ImGui::TextWrapped("The recording measures nothing that the model reports.");
  const auto after = std::ranges::upper_bound(gap->time_s, player.timeS());
  const auto row = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after - gap->time_s.begin())) - 1;
  const std::vector<double> residuals = gap->residuals();
  Range values, differences;
  for (const auto* of : {&gap->measured, &gap->simulated})
    for (const double value : *of) values.add(value);
  for (const double value : residuals) differences.add(value);
  for (const double side : {-1.0, 1.0}) differences.add(side * gap->band());

  coloredWords("measured", gap->measured, row, measured_ink);
  ImGui::SameLine();
  coloredWords("simulated", gap->simulated, row, simulated_ink);
  Diagram2d above(player, values.widened(), height_px);
  above.curve(gap->time_s, gap->measured, measured_ink, 2.4F);
  above.curve(gap->time_s, gap->simulated, simulated_ink, 1.3F);
  above.finish();

  coloredWords("residual", residuals, row, residual_ink);
  ImGui::SameLine();
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(number_ink), "noise band +-%.3g", gap->band());
  Diagram2d below(player, differences.widened(), height_px);
  below.band(gap->band());
  below.curve(gap->time_s, residuals, residual_ink, 1.4F);
  below.finish();
}

}  // namespace musclesim
