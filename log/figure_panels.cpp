#include "figure_panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "columns.h"
#include "musclesim/base/color.h"
#include "musclesim/base/error.h"
#include "svg.h"

namespace musclesim {

namespace {

const Color height_color{0.87, 0.05, 0.05, "red"}, target_color{1.0, 0.55, 0.0, "orange"}, activity_color{0.1, 0.6, 0.1, "green"};

bool isMeasured(const Signal* signal) {
  return signal && std::any_of(signal->values.begin(), signal->values.end(), [](double value) { return !std::isnan(value); });
}

/// All measured signals "<quantity>_<i><unit>", each in the colour of its muscle.
std::vector<Curve> muscleCurves(const Recording& recording, const std::string& quantity, const std::string& unit,
                                const std::vector<Color>& muscle_colors) {
  std::vector<Curve> curves;
  for (std::size_t muscle = 0; muscle < static_cast<std::size_t>(recording.muscleCount()); ++muscle) {
    const Signal* signal = recording.find(fmt::format("{}_{}{}", quantity, muscle, unit));
    if (!isMeasured(signal)) continue;
    const Color color = muscleColor(muscle, muscle_colors);
    curves.push_back({signal, color, fmt::format("{} {}", muscle, color.name)});
    if (quantity == "command") curves.back().between = Between::held;
  }
  return curves;
}

std::vector<Curve> angleCurves(const Recording& recording) {
  std::vector<Curve> curves;
  for (const auto& signal : recording.signals) {
    if (!signal.name.starts_with("angle_") || !signal.name.ends_with("_deg") || !isMeasured(&signal)) continue;
    const std::string prefix = "angle_", suffix = "_deg";
    const std::string joint = signal.name.substr(prefix.size(), signal.name.size() - prefix.size() - suffix.size());
    curves.push_back({&signal, muscleColor(curves.size(), {}), joint});
  }
  return curves;
}

}  // namespace

Panel upperPanel(const Recording& recording, const std::vector<Color>& muscle_colors) {
  Panel panel;
  if (const Signal* height = recording.find("hand_y_mm"); isMeasured(height)) {
    panel.axis_title = "height (mm)";
    panel.curves.push_back({height, height_color, "height of the hand", Between::straight, 1.8});
    if (const Signal* target = recording.find("target_y_mm"); isMeasured(target))
      panel.curves.push_back({target, target_color, "target", Between::held, 2});
  } else if (panel.curves = angleCurves(recording); !panel.curves.empty()) {
    panel.axis_title = "angle (degrees)";
  } else if (panel.curves = muscleCurves(recording, "length", "_mm", muscle_colors); !panel.curves.empty()) {
    panel.axis_title = "length (mm)";
  } else if (panel.curves = muscleCurves(recording, "force", "_N", muscle_colors); !panel.curves.empty()) {
    panel.axis_title = "force (N)";
  }
  if (const Signal* activity = recording.find("activity"); isMeasured(activity)) {
    panel.right_curves.push_back({activity, activity_color, "activity"});
    panel.right_axis_title = "activity";
  }
  return panel;
}

Panel lowerPanel(const Recording& recording, const std::vector<Color>& muscle_colors) {
  Panel panel;
  panel.is_fraction = true;
  panel.axis_title = "pressure (fraction)";
  panel.curves = muscleCurves(recording, "pressure", "", muscle_colors);
  if (!panel.curves.empty()) return panel;
  panel.axis_title = "command (fraction)";
  panel.curves = muscleCurves(recording, "command", "", muscle_colors);
  return panel;
}

std::vector<const Signal*> signalsNamed(const Recording& recording, const std::vector<std::string>& names) {
  std::vector<const Signal*> found;
  for (const std::string& name : names) {
    const bool is_begin = name.ends_with('*');
    const std::size_t before = found.size();
    for (const Signal& signal : recording.signals)
      if (is_begin ? signal.name.starts_with(name.substr(0, name.size() - 1)) : signal.name == name) found.push_back(&signal);
    if (found.size() > before) continue;
    std::vector<std::string> known;
    for (const Signal& signal : recording.signals) known.push_back(signal.name);
    const std::string nearest = nearestName(name, known);
    throw BadParameter("signal", name,
                       "be one of the recording" + (nearest.empty() ? std::string() : "; did you mean \"" + nearest + "\"?"));
  }
  return found;
}

namespace {

/// "angle (deg)": the title of the axis, by which signals share a panel. Only its controller knows the unit of a controller's own signal.
std::string axisTitle(const std::string& signal) {
  const Column column = parseColumnName(signal);
  if (column.quantity == "controller") return signal;
  const bool is_height = column.quantity == "target" && column.canonical_unit == "mm";
  const std::string quantity = column.quantity != "target" ? column.quantity : is_height ? "hand" : "angle";
  const bool is_fraction = quantity == "command" || quantity == "pressure";
  return quantity + (is_fraction ? " (fraction)" : column.canonical_unit.empty() ? "" : " (" + column.canonical_unit + ")");
}

Curve chosenCurve(const Signal& signal, std::size_t number, const std::vector<Color>& muscle_colors) {
  const Column column = parseColumnName(signal.name);
  const bool is_target = column.quantity == "target";
  const Color color = is_target            ? target_color
                      : column.muscle >= 0 ? muscleColor(static_cast<std::size_t>(column.muscle), muscle_colors)
                                           : muscleColor(number, {});
  return {&signal, color, signal.name, column.quantity == "command" ? Between::held : Between::straight, is_target ? 2.0 : 1.3};
}

}  // namespace

std::vector<Panel> signalPanels(const Recording& recording, const std::vector<std::string>& signals,
                                const std::vector<Color>& muscle_colors) {
  std::vector<Panel> panels;
  for (const Signal* signal : signalsNamed(recording, signals)) {
    const std::string title = axisTitle(signal->name);
    auto panel = std::ranges::find(panels, title, &Panel::axis_title);
    if (panel == panels.end()) panel = panels.insert(panel, Panel{{}, title, {}, "", false});
    const auto colored = std::ranges::count_if(panel->curves, [](const Curve& curve) { return !curve.label.starts_with("target"); });
    panel->curves.push_back(chosenCurve(*signal, static_cast<std::size_t>(colored), muscle_colors));
  }
  return panels;
}

}  // namespace musclesim
