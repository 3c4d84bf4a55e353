#include "look_alikes.h"

#include <algorithm>

#include "musclesim/effect/catalogue.h"
#include "musclesim/robot/robot.h"

namespace musclesim::blind {

namespace {

/// Whether the effect acts on a single component that this robot has or measures, whatever its name.
bool actsOnOnePlace(const std::string& id, const Measured& measured, const Robot& robot) {
  const EffectInfo info = effectInfo(id);
  return componentsFor(info, robot).size() <= 1 || (info.stage == Stage::sensor && measured.signal_count == 1);
}

/// The component of a look-alike: the same one if it exists, otherwise any.
std::string patternOf(const std::string& id, const std::string& component, const Robot& robot) {
  const std::vector<std::string> components = componentsFor(effectInfo(id), robot);
  const bool known = std::ranges::find(components, component) != components.end();
  return id + "@" + (known && components.size() > 1 ? component : "*");
}

/// Pairs of effects that some recordings cannot distinguish.
struct LookAlikes {
  bool holds(const std::string& id) const { return std::ranges::find(ids, id) != ids.end(); }

  std::vector<std::string> ids;
  bool (*inseparable)(const Measured&);  ///< whether the measured signals never distinguish them on the same component, whatever the motion
};

const std::vector<LookAlikes>& lookAlikes() {
  const auto without_pressure = [](const Measured& measured) { return !measured.pressure; };
  const auto without_both = [](const Measured& measured) { return !measured.pressure && !measured.force; };
  const auto by_motion = [](const Measured&) { return false; };  // pairs on other components: see acceptableAnswers
  static const std::vector<LookAlikes> classes = {{{"valve_lag", "viscous_loss", "joint_viscous_friction"}, without_both},
                                                  {{"force_gain", "pressure_calibration"}, without_pressure},
                                                  {{"leak", "creep", "regulator_tail"}, without_pressure},
                                                  {{"transport_delay", "sensor_delay"}, by_motion},
                                                  {{"braid_hysteresis", "joint_coulomb_friction", "slide_friction"}, by_motion},
                                                  {{"length_offset", "attachment_offset"}, by_motion},
                                                  {{"payload", "force_gain"}, by_motion},
                                                  {{"base_tilt", "external_force", "sensor_bias"}, by_motion},
                                                  {{"joint_stop_offset", "contact"}, by_motion}};
  return classes;
}

std::vector<std::string> membersBeside(const std::string& id, const Measured& measured) {
  std::vector<std::string> others;
  for (const LookAlikes& one : lookAlikes())
    if (one.holds(id) && one.inseparable(measured))
      std::ranges::copy_if(one.ids, std::back_inserter(others), [&](const std::string& other) { return other != id; });
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
  if (id == "base_tilt" && robot.angles().size() <= 1) patterns.emplace_back("external_force@*");
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
  return std::ranges::any_of(lookAlikes(), [&](const LookAlikes& c) { return c.holds(one_id) && c.holds(other_id); });
}

std::string idOf(const std::string& label) {
  return label.substr(0, label.find('@'));
}

}  // namespace musclesim::blind
