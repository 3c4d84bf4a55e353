#include "musclesim/effect/relevance.h"

#include <algorithm>

namespace musclesim {

namespace {

/// Kind of quantity that a component or a parameter is about.
enum class Measure { angle, length, any };

Measure measureOf(const std::string& component) {
  const bool angle = component.starts_with("joint_") || component.starts_with("signal_angle_");
  const bool length = component == "hand" || component.starts_with("signal_length_") || component.starts_with("signal_hand_");
  return angle ? Measure::angle : length ? Measure::length : Measure::any;
}

Measure measureOf(const EffectParameter& parameter) {
  if (parameter.name.ends_with("_deg")) return Measure::angle;
  const bool of_position = parameter.name.ends_with("_mm") || parameter.name == "axis";
  return of_position ? Measure::length : Measure::any;
}

}  // namespace

std::vector<std::size_t> relevantParameters(const EffectInfo& info, const std::string& component) {
  auto has = [&](Measure measure) {
    return std::any_of(info.parameters.begin(), info.parameters.end(), [&](const auto& p) { return measureOf(p) == measure; });
  };
  const bool by_place = component != "all" && has(Measure::angle) && has(Measure::length);
  const Measure place = measureOf(component);
  std::vector<std::size_t> relevant;
  for (std::size_t i = 0; i < info.parameters.size(); ++i) {
    const Measure parameter = measureOf(info.parameters[i]);
    if (!by_place || parameter == Measure::any || parameter == place) relevant.push_back(i);
  }
  return relevant;
}

}  // namespace musclesim
