/// A small diagram of the last seconds, drawn with Dear ImGui.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "history.h"

namespace musclesim {

struct PlotCurve {
  std::string name;
  Color color;
  std::function<std::optional<double>(const History::Sample&)> value;
};

/// Draws at ImGui's cursor: a title with the latest values, a frame, curves over time. Without `range`, the range follows the values.
void drawPlot(const std::string& title, const std::vector<PlotCurve>& curves, const History& history, float height_px,
              std::optional<std::pair<double, double>> range);

}  // namespace musclesim
