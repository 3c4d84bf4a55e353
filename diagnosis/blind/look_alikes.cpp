#include "look_alikes.h"

#include <algorithm>

#include "musclesim/effect/catalogue.h"
#include "musclesim/robot/robot.h"

namespace musclesim::blind {

namespace {

/// Whether the effect acts on one place only that this robot has or that is measured, whatever it is called.
bool actsOnOnePlace(const std::string& id, const Measured& measured, const Robot& robot) {
  const EffectInfo info = effectInfo(id);
  return componentsFor(info, robot).size() <= 1 || (info.stage == Stage::sensor && measured.signal_count == 1);
}

/// The component under which a look-alike would be named: the same one where it exists, otherwise any.
std::string patternOf(const std::string& id, const std::string& component, const Robot& robot) {
  const std::vector<std::string> components = componentsFor(effectInfo(id), robot);
  const bool known = std::ranges::find(components, component) != components.end();
  return id + "@" + (known && components.size() > 1 ? component : "*");
}

std::vector<std::string> membersBeside(const std::string& id, const Measured& measured) {
  std::vector<std::vector<std::string>> classes;
  if (!measured.pressure && !measured.force) classes.push_back({"valve_lag", "viscous_loss", "joint_viscous_friction"});
  if (!measured.pressure) {
    classes.push_back({"force_gain", "pressure_calibration"});
    classes.push_back({"leak", "creep"});
  }
  std::vector<std::string> others;
  for (const auto& members : classes)
    if (std::ranges::find(members, id) != members.end())
      std::ranges::copy_if(members, std::back_inserter(others), [&](const std::string& other) { return other != id; });
  return others;
}

std::string componentOf(const std::string& label) {
  const auto at = label.find('@');
  return at == std::string::npos ? "all" : label.substr(at + 1);
}

std::string otherOrder(const std::string& pair) {
  const auto plus = pair.find('+');
  return plus == std::string::npos ? pair : pair.substr(plus + 1) + "+" + pair.substr(0, plus);
}

}  // namespace

Measured measuredBy(const std::vector<std::string>& signals) {
  Measured measured;
  for (const std::string& name : signals) {
    measured.pressure = measured.pressure || name.starts_with("pressure_");
    measured.force = measured.force || name.starts_with("force_");
  }
  measured.signal_count = static_cast<int>(signals.size());
  return measured;
}

std::vector<std::string> acceptableAnswers(const std::string& id, const std::string& component, const std::vector<std::string>& signals,
                                           const Robot& robot) {
  const Measured measured = measuredBy(signals);
  const bool only_motion = !measured.pressure && !measured.force, single = measured.signal_count == 1;
  std::vector<std::string> patterns = {id + "@" + (actsOnOnePlace(id, measured, robot) ? "*" : component)};
  for (const std::string& other : membersBeside(id, measured))
    if (!componentsFor(effectInfo(other), robot).empty()) patterns.push_back(patternOf(other, component, robot));
  if (id == "transport_delay" && only_motion) patterns.push_back(single ? "sensor_delay@*" : "sensor_delay@all");
  if (id == "sensor_delay" && only_motion && single)
    patterns.push_back(robot.actuatorCount() == 1 ? "transport_delay@*" : "transport_delay@all");
  if (id == "joint_stop_offset") patterns.push_back(patternOf("contact", component, robot));
  return patterns;
}

bool fits(const std::string& answer, const std::string& pattern) {
  static const std::set<std::string> whole = {"hand", "base", "all"};
  if (idOf(answer) != idOf(pattern)) return false;
  const std::string given = componentOf(answer), wanted = componentOf(pattern);
  return wanted == "*" || given == wanted || otherOrder(given) == wanted || (whole.contains(given) && whole.contains(wanted));
}

bool fitsAny(const std::string& answer, const std::vector<std::string>& patterns) {
  return std::ranges::any_of(patterns, [&](const std::string& pattern) { return fits(answer, pattern); });
}

bool areOfOneClass(const std::string& one_id, const std::string& other_id) {
  static const std::vector<std::set<std::string>> classes = {{"valve_lag", "viscous_loss", "joint_viscous_friction"},
                                                             {"transport_delay", "sensor_delay"},
                                                             {"force_gain", "pressure_calibration"},
                                                             {"leak", "creep"},
                                                             {"braid_hysteresis", "joint_coulomb_friction"},
                                                             {"length_offset", "attachment_offset"},
                                                             {"payload", "force_gain"},
                                                             {"base_tilt", "external_force", "sensor_bias"},
                                                             {"joint_stop_offset", "contact"}};
  return std::ranges::any_of(classes, [&](const auto& ids) { return ids.contains(one_id) && ids.contains(other_id); });
}

std::string idOf(const std::string& label) {
  return label.substr(0, label.find('@'));
}

}  // namespace musclesim::blind
