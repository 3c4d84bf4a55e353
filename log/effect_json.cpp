#include "effect_json.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

using nlohmann::json;

void readParameters(const json& values, const std::string& path, const RefuseJson& refuse, ActiveEffect& effect) {
  if (!values.is_object()) refuse(path, values, "be an object: {\"name\": number, ...}");
  for (const auto& [name, value] : values.items()) {
    if (!value.is_number() && !value.is_string()) refuse(path + "." + name, value, "be a number, \"inf\" or a word");
    if (value.is_number())
      effect.parameters[name] = value.get<double>();
    else if (value == "inf")
      effect.parameters[name] = std::numeric_limits<double>::infinity();
    else
      effect.parameters[name] = value.get<std::string>();
  }
}

ActiveEffect effectFromJson(const json& value, const std::string& path, const RefuseJson& refuse) {
  if (!value.is_object()) refuse(path, value, "be an object with the members id, component, parameters");
  ActiveEffect effect;
  for (const auto& [key, entry] : value.items()) {
    const std::string entry_path = path + "." + key;
    if (key == "parameters") {
      readParameters(entry, entry_path, refuse, effect);
    } else if (key == "id" || key == "component") {
      if (!entry.is_string() || entry.get<std::string>().empty()) refuse(entry_path, entry, "be a string that is not empty");
      (key == "id" ? effect.id : effect.component) = entry.get<std::string>();
    } else {
      refuse(entry_path, entry, "be one of the members id, component, parameters");
    }
  }
  if (effect.id.empty()) refuse(path, value, "have the member \"id\"");
  return effect;
}

nlohmann::ordered_json jsonOf(const Parameter::Value& value, const std::string& name) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  const double number = std::get<double>(value);
  if (number == std::numeric_limits<double>::infinity()) return "inf";
  if (!std::isfinite(number)) throw BadParameter(name, fmt::format("{}", number), "be a number or infinity");
  return number;
}

}  // namespace

std::string shortJson(const json& value) {
  constexpr std::size_t longest = 40;
  if (value.is_object()) return "{...}";
  if (value.is_array()) return "[...]";
  const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() > longest ? text.substr(0, longest) + "..." : text;
}

std::vector<ActiveEffect> effectsFromJson(const json& list, const std::string& path, const RefuseJson& refuse) {
  if (!list.is_array()) refuse(path, list, "be a list: [{\"id\": ..., \"component\": ..., \"parameters\": {...}}, ...]");
  constexpr std::size_t most_effects = 1000;
  if (list.size() > most_effects) refuse(path, list, fmt::format("have {} effects at most", most_effects));
  std::vector<ActiveEffect> effects;
  for (const auto& value : list) effects.push_back(effectFromJson(value, fmt::format("{}[{}]", path, effects.size()), refuse));
  return effects;
}

nlohmann::ordered_json jsonOf(const std::vector<ActiveEffect>& effects) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ActiveEffect& effect : effects) {
    nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
    for (const auto& [name, value] : effect.parameters) parameters[name] = jsonOf(value, effect.id + "." + name);
    list.push_back({{"id", effect.id}, {"component", effect.component}, {"parameters", parameters}});
  }
  return list;
}

}  // namespace musclesim
