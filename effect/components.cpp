#include "components.h"

#include <fmt/format.h>

#include <algorithm>

#include "musclesim/base/error.h"
#include "musclesim/log/recording.h"
#include "musclesim/robot/robot.h"

namespace musclesim {

std::string stemOf(const std::string& signal) {
  const std::string unit = signalUnit(signal);
  return unit.empty() ? signal : signal.substr(0, signal.size() - unit.size() - 1);
}

namespace {

/// A component with a single place.
struct NamedPlace {
  ComponentKind kind;
  std::string name;
  int first = -1, second = -1;
  std::string joint = {};
};

void addMuscles(const Robot& robot, ComponentKind kind, std::vector<NamedPlace>& places) {
  for (int i = 0; i < robot.actuatorCount(); ++i) {
    if (kind == ComponentKind::muscle) places.push_back({kind, fmt::format("muscle_{}", i), i});
    if (kind == ComponentKind::muscle_pair)
      for (int j = i + 1; j < robot.actuatorCount(); ++j) places.push_back({kind, fmt::format("muscle_{}+muscle_{}", i, j), i, j});
  }
}

void addSignals(const Robot& robot, std::vector<NamedPlace>& places) {
  const std::vector<std::string> names = robot.signalNames();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!names[i].starts_with("command_")) places.push_back({ComponentKind::signal, "signal_" + stemOf(names[i]), static_cast<int>(i)});
}

std::vector<NamedPlace> namedPlaces(const EffectInfo& info, const Robot& robot) {
  std::vector<NamedPlace> places;
  for (const ComponentKind kind : info.acts_on) switch (kind) {
      case ComponentKind::muscle:
      case ComponentKind::muscle_pair:
        addMuscles(robot, kind, places);
        break;
      case ComponentKind::joint:
        for (const auto& angle : robot.angles()) places.push_back({kind, "joint_" + angle.name, -1, -1, angle.name});
        break;
      case ComponentKind::slide:
        for (const auto& slide : robot.slides()) places.push_back({kind, "slide_" + slide.name, -1, -1, slide.name});
        break;
      case ComponentKind::hand:
        if (robot.hand()) places.push_back({kind, "hand"});
        break;
      case ComponentKind::base:
        places.push_back({kind, "base"});
        break;
      case ComponentKind::all_muscles:
        if (robot.actuatorCount() > 0) places.push_back({kind, "all"});
        break;
      case ComponentKind::signal:
        addSignals(robot, places);
        break;
    }
  return places;
}

/// Effects on pairs of muscles do not allow "all": every muscle would be in several pairs.
bool allowsAll(const EffectInfo& info) {
  return std::find(info.acts_on.begin(), info.acts_on.end(), ComponentKind::muscle_pair) == info.acts_on.end();
}

/// For an effect that acts on several kinds of components, "all" means all components of the first kind that the robot has.
bool chosen(const NamedPlace& place, const std::string& component, const std::vector<NamedPlace>& places) {
  if (component == "all") return place.kind == places.front().kind;
  return place.name == component ||
         (place.kind == ComponentKind::muscle_pair && component == fmt::format("muscle_{}+muscle_{}", place.second, place.first));
}

}  // namespace

std::vector<std::string> componentsFor(const EffectInfo& info, const Robot& robot) {
  std::vector<std::string> names;
  const std::vector<NamedPlace> places = namedPlaces(info, robot);
  if (places.size() > 1 && allowsAll(info)) names.push_back("all");
  for (const NamedPlace& place : places) names.push_back(place.name);
  return names;
}

std::vector<EffectPlace> placesFor(const EffectInfo& info, const std::string& component, World& world, Robot& robot) {
  const std::vector<NamedPlace> all = namedPlaces(info, robot);
  std::vector<EffectPlace> places;
  for (const NamedPlace& place : all) {
    if (!chosen(place, component, all) || (component == "all" && !allowsAll(info))) continue;
    const bool is_signal = place.kind == ComponentKind::signal;
    places.push_back({world, robot, place.kind, is_signal ? -1 : place.first, place.second, place.joint, is_signal ? place.first : -1,
                      place.name, component == "all"});
  }
  if (places.empty()) {
    const std::vector<std::string> names = componentsFor(info, robot);
    throw BadParameter(fmt::format("component of {}", info.id), fmt::format("\"{}\"", component),
                       names.empty() ? fmt::format("exist; the robot {} has no component that the effect can act on", robot.name())
                                     : fmt::format("be one of {}", fmt::join(names, ", ")));
  }
  return places;
}

}  // namespace musclesim
