#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "effect_json.h"
#include "musclesim/base/error.h"
#include "musclesim/base/json_document.h"
#include "musclesim/log/csv.h"
#include "sidecar.h"

namespace musclesim {

namespace {

using OrderedJson = nlohmann::ordered_json;

void requireNumber(const std::string& name, double value) {
  if (!std::isfinite(value)) throw BadParameter(name, fmt::format("{}", value), "be a finite number");
}

OrderedJson parameterJson(const std::string& name, const Parameter::Value& value) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  requireNumber(name, std::get<double>(value));
  return std::get<double>(value);
}

void addNumber(OrderedJson& object, const std::string& name, const std::optional<double>& value) {
  if (!value) return;
  requireNumber(name, *value);
  object[name] = *value;
}

void addText(OrderedJson& object, const std::string& name, const std::string& value) {
  if (!value.empty()) object[name] = value;
}

OrderedJson sidecarJson(const RecordingInfo& info) {
  OrderedJson object = {{"format", recording_format}, {"robot", info.robot}};
  addText(object, "robot_hash", info.robot_hash);
  addText(object, "physics", info.physics.value_or(""));
  addText(object, "initial_state", info.initial_state.value_or(""));
  for (const auto& [name, value] : info.robot_parameters)
    object["robot_parameters"][name] = parameterJson("robot_parameters." + name, value);
  if (!info.varies.empty()) object["varies"] = info.varies;
  for (const auto& [name, value] : info.parameter_tolerance) addNumber(object["parameter_tolerance"], name, value);
  addText(object, "description", info.description);
  addText(object, "trial", info.trial);
  addText(object, "repeat_of", info.repeat_of);
  addNumber(object, "pressure_full_scale_kPa", info.pressure_full_scale_kPa);
  addNumber(object, "command_full_scale_V", info.command_full_scale_V);
  for (const auto& [name, value] : info.noise_std) addNumber(object["noise_std"], name, value);
  if (!info.active_effects.empty()) object["active_effects"] = jsonOf(info.active_effects);
  if (info.seed) object["seed"] = *info.seed;
  addNumber(object, "step_s", info.step_s);
  addNumber(object, "skip_start_s", info.skip_start_s);
  addText(object, "program", info.program);
  if (info.complete) object["complete"] = *info.complete;
  if (info.extra_json.empty()) return object;
  const JsonDocument further(info.extra_json, "extra_json");
  for (const auto& [member, value] : further.root().items()) object[member] = value;
  return object;
}

/// The way from a file's folder to another file, so that both can be moved together.
std::string pathFromFolderOf(const std::string& file, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  return std::filesystem::absolute(path).lexically_normal().lexically_proximate(folder.lexically_normal()).string();
}

/// Runs `action` and rethrows BadFile as BadParameter, since the text comes from the caller and not from a file.
template <class Action>
auto asBadParameter(const Action& action) {
  try {
    return action();
  } catch (const BadFile& error) {
    throw BadParameter(error.what());
  }
}

}  // namespace

RecordingInfo withMember(const RecordingInfo& info, const std::string& member, const std::string& json_value) {
  OrderedJson object = asBadParameter([&] { return sidecarJson(info); });
  try {
    object[member] = OrderedJson::parse(json_value);
  } catch (const OrderedJson::exception&) {
    throw BadParameter(fmt::format("sidecar member {} = {}: must be JSON", inQuotes(member), inQuotes(json_value)));
  }
  std::vector<std::string> notes;
  return asBadParameter(
      [&] { return parseSidecar(object.dump(-1, ' ', false, OrderedJson::error_handler_t::replace), "sidecar", {}, notes); });
}

std::string sidecarText(const RecordingInfo& info, const std::string& file) {
  constexpr int indent = 2;
  return asBadParameter([&] {
    OrderedJson object = sidecarJson(info);
    if (!file.empty() && info.robot.ends_with(".toml")) object["robot"] = pathFromFolderOf(file, info.robot);
    const std::string text = object.dump(indent, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
    std::vector<std::string> notes;
    parseSidecar(text, "sidecar", {}, notes);
    return text;
  });
}

}  // namespace musclesim
