#include "sidecar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "columns.h"
#include "effect_json.h"
#include "musclesim/base/error.h"
#include "musclesim/base/json_document.h"
#include "musclesim/log/csv.h"

namespace musclesim {

namespace {

using nlohmann::json;

const std::vector<std::string>& knownMembers() {
  static const std::vector<std::string> names = {"format",
                                                 "robot",
                                                 "robot_hash",
                                                 "physics",
                                                 "initial_state",
                                                 "robot_parameters",
                                                 "description",
                                                 "trial",
                                                 "pressure_full_scale_kPa",
                                                 "command_full_scale_V",
                                                 "noise_std",
                                                 "active_effects",
                                                 "varies",
                                                 "parameter_tolerance",
                                                 "repeat_of",
                                                 "seed",
                                                 "step_s",
                                                 "skip_start_s",
                                                 "program",
                                                 "complete"};
  return names;
}

constexpr std::size_t most_robot_parameters = 10'000;

/// Further members that runs of this program write. The reader accepts them without a note.
bool isOfARun(const std::string& member) {
  static const std::vector<std::string> names = {"controller",      "task",       "stepper", "substeps",  "substeps_automatic",
                                                 "internal_step_s", "parameters", "verdict", "by_hand_s", "run",
                                                 "pulls",           "repeats"};
  return std::find(names.begin(), names.end(), member) != names.end();
}

/// A path that is relative to a file's folder, as seen from the working directory.
std::string fromFolderOf(const std::string& file, const std::string& path) {
  return (std::filesystem::path(file).parent_path() / path).lexically_normal().string();
}

bool isKnown(const std::string& member) {
  return std::find(knownMembers().begin(), knownMembers().end(), member) != knownMembers().end();
}

/// Reads the members one by one. Each function refuses a wrong type or value and gives its place.
class SidecarReader {
 public:
  SidecarReader(const std::string& text, const std::string& file, const std::vector<std::string>& ignore_columns)
      : document_(text, file), file_(file), ignore_columns_(ignore_columns) {}

  RecordingInfo read(std::vector<std::string>& notes);

 private:
  [[noreturn]] void refuse(const std::string& member, const std::string& path, const json& value, const std::string& allowed) const {
    document_.refuse(member, fmt::format("{} = {}: must {}", path, shortJson(value), allowed));
  }
  void requireFormat() const;
  std::string text(const std::string& member, bool required = false) const;
  std::vector<std::string> texts(const std::string& member) const;
  std::optional<std::string> choice(const std::string& member, const std::vector<std::string>& allowed) const;
  std::optional<double> positive(const std::string& member, const std::string& unit) const;
  std::optional<double> notNegative(const std::string& member, const std::string& unit) const;
  std::optional<std::uint64_t> seed() const;
  std::optional<bool> complete() const;
  void readRobotParameters(const json& values, const std::string& prefix, std::map<std::string, Parameter::Value>& parameters) const;
  void readTolerances(const json& values, const std::string& prefix, std::map<std::string, double>& tolerances) const;
  void readNoise(RecordingInfo& info) const;
  std::vector<ActiveEffect> effects() const;
  void keepFurtherMembers(RecordingInfo& info, std::vector<std::string>& notes) const;

  JsonDocument document_;
  std::string file_;
  const std::vector<std::string>& ignore_columns_;
};

RecordingInfo SidecarReader::read(std::vector<std::string>& notes) {
  requireFormat();
  RecordingInfo info;
  info.robot = text("robot", true);
  if (info.robot.ends_with(".toml")) info.robot = fromFolderOf(file_, info.robot);
  info.robot_hash = text("robot_hash");
  info.physics = choice("physics", {"si", "original", "scaled"});
  info.initial_state = choice("initial_state", {"settled", "built"});
  if (const json* values = document_.find("robot_parameters")) readRobotParameters(*values, "", info.robot_parameters);
  info.varies = texts("varies");
  if (const json* values = document_.find("parameter_tolerance")) readTolerances(*values, "", info.parameter_tolerance);
  info.description = text("description");
  info.trial = text("trial");
  info.repeat_of = text("repeat_of");
  info.program = text("program");
  info.pressure_full_scale_kPa = positive("pressure_full_scale_kPa", "kPa");
  info.command_full_scale_V = positive("command_full_scale_V", "V");
  info.step_s = positive("step_s", "s");
  info.skip_start_s = notNegative("skip_start_s", "s");
  info.seed = seed();
  info.complete = complete();
  readNoise(info);
  info.active_effects = effects();
  keepFurtherMembers(info, notes);
  return info;
}

void SidecarReader::requireFormat() const {
  const json* value = document_.find("format");
  const std::string allowed = fmt::format("be \"{}\"", recording_format);
  if (!value) document_.refuse("format", fmt::format("member \"format\" is missing: must {}", allowed));
  if (*value != recording_format) refuse("format", "format", *value, allowed);
}

std::string SidecarReader::text(const std::string& member, bool required) const {
  const json* value = document_.find(member);
  if (!value && !required) return "";
  if (!value)
    document_.refuse(member,
                     fmt::format("member \"{}\" is missing: must be the robot's name, for example \"rig\", \"elbow\" or \"arm\"", member));
  if (!value->is_string()) refuse(member, member, *value, "be a string (leave the member out if it is not known)");
  auto word = value->get<std::string>();
  if (required && word.empty()) refuse(member, member, *value, "not be empty");
  return word;
}

std::vector<std::string> SidecarReader::texts(const std::string& member) const {
  const json* value = document_.find(member);
  if (!value) return {};
  const bool fine = value->is_array() && std::ranges::all_of(*value, [](const json& entry) { return entry.is_string(); });
  if (!fine) refuse(member, member, *value, "be a list of names");
  return value->get<std::vector<std::string>>();
}

std::optional<std::string> SidecarReader::choice(const std::string& member, const std::vector<std::string>& allowed) const {
  const json* value = document_.find(member);
  if (!value) return std::nullopt;
  const bool known = std::any_of(allowed.begin(), allowed.end(), [&](const std::string& word) { return *value == word; });
  if (!known) refuse(member, member, *value, fmt::format("be \"{}\"", fmt::join(allowed, "\" or \"")));
  return value->get<std::string>();
}

std::optional<double> SidecarReader::positive(const std::string& member, const std::string& unit) const {
  const json* value = document_.find(member);
  if (!value) return std::nullopt;
  if (!value->is_number() || !(value->get<double>() > 0)) refuse(member, member, *value, fmt::format("be a number above 0 {}", unit));
  return value->get<double>();
}

std::optional<double> SidecarReader::notNegative(const std::string& member, const std::string& unit) const {
  const json* value = document_.find(member);
  if (!value) return std::nullopt;
  if (!value->is_number() || !(value->get<double>() >= 0)) refuse(member, member, *value, fmt::format("be a number of 0 {} or more", unit));
  return value->get<double>();
}

std::optional<std::uint64_t> SidecarReader::seed() const {
  const json* value = document_.find("seed");
  if (!value) return std::nullopt;
  if (!value->is_number_unsigned())
    refuse("seed", "seed", *value, fmt::format("be a whole number in 0 .. {}", std::numeric_limits<std::uint64_t>::max()));
  return value->get<std::uint64_t>();
}

std::optional<bool> SidecarReader::complete() const {
  const json* value = document_.find("complete");
  if (!value) return std::nullopt;
  if (!value->is_boolean()) refuse("complete", "complete", *value, "be true or false");
  return value->get<bool>();
}

void SidecarReader::readRobotParameters(const json& values, const std::string& prefix,
                                        std::map<std::string, Parameter::Value>& parameters) const {
  if (!values.is_object()) refuse("robot_parameters", "robot_parameters", values, "be an object: {\"name\": value, ...}");
  for (const auto& [key, value] : values.items()) {
    const std::string name = prefix + key;
    const std::string path = "robot_parameters." + name;
    if (key.empty()) refuse("robot_parameters", path, value, "have a name");
    if (value.is_object()) {
      readRobotParameters(value, name + ".", parameters);
      continue;
    }
    if (!value.is_number() && !value.is_string()) refuse("robot_parameters", path, value, "be a number, a string, or an object of these");
    const Parameter::Value parameter =
        value.is_number() ? Parameter::Value(value.get<double>()) : Parameter::Value(value.get<std::string>());
    if (!parameters.emplace(name, parameter).second) refuse("robot_parameters", path, value, "be given once");
    if (parameters.size() > most_robot_parameters)
      refuse("robot_parameters", "robot_parameters", values, fmt::format("have {} numbers at most", most_robot_parameters));
  }
}

void SidecarReader::readTolerances(const json& values, const std::string& prefix, std::map<std::string, double>& tolerances) const {
  const std::string member = "parameter_tolerance";
  if (!values.is_object()) refuse(member, member, values, "be an object: {\"name\": number, ...}");
  for (const auto& [key, value] : values.items()) {
    const std::string name = prefix + key;
    const std::string path = member + "." + name;
    if (key.empty()) refuse(member, path, value, "have a name");
    if (value.is_object()) {
      readTolerances(value, name + ".", tolerances);
      continue;
    }
    if (!value.is_number() || !isTolerance(value.get<double>()))
      refuse(member, path, value, fmt::format("be a number above 0 and at most {}, a share of the parameter", largest_tolerance));
    if (!tolerances.emplace(name, value.get<double>()).second) refuse(member, path, value, "be given once");
  }
}

void SidecarReader::readNoise(RecordingInfo& info) const {
  const json* values = document_.find("noise_std");
  if (!values) return;
  if (!values->is_object()) refuse("noise_std", "noise_std", *values, "be an object: {\"column\": number, ...}");
  for (const auto& [key, value] : values->items()) {
    const std::string path = "noise_std." + key;
    if (std::find(ignore_columns_.begin(), ignore_columns_.end(), key) != ignore_columns_.end()) continue;
    if (!value.is_number() || !(value.get<double>() >= 0))
      refuse("noise_std", path, value, "be a number, 0 or more, in the unit of its column");
    try {
      const Column column = parseColumnName(key);
      const double deviation = value.get<double>() * column.factor / fullScale(column, info);
      if (!info.noise_std.emplace(column.name, deviation).second) refuse("noise_std", path, value, "be given once per quantity");
    } catch (const BadParameter& error) {
      document_.refuse("noise_std", std::string("noise_std: ") + error.what());
    }
  }
}

std::vector<ActiveEffect> SidecarReader::effects() const {
  const json* values = document_.find("active_effects");
  if (!values) return {};
  return effectsFromJson(*values, "active_effects", [&](const std::string& path, const json& value, const std::string& allowed) {
    refuse("active_effects", path, value, allowed);
  });
}

void SidecarReader::keepFurtherMembers(RecordingInfo& info, std::vector<std::string>& notes) const {
  constexpr int most_named = 20;
  json further = json::object();
  std::string names;
  int unknown_count = 0;
  for (const auto& [member, value] : document_.root().items()) {
    if (isKnown(member)) continue;
    further[member] = value;
    if (isOfARun(member)) continue;
    if (++unknown_count > most_named) continue;
    const std::string nearest = nearestName(member, knownMembers());
    names += (names.empty() ? "" : ", ") + inQuotes(member) + (nearest.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", nearest));
  }
  info.extra_json = further.dump();
  if (unknown_count > most_named) names += fmt::format(" and {} more", unknown_count - most_named);
  if (!names.empty()) notes.push_back("unknown members of the sidecar, kept unchanged: " + names);
}

}  // namespace

bool isSidecarMember(const std::string& name) {
  return isKnown(name) || isOfARun(name);
}

RecordingInfo parseSidecar(const std::string& text, const std::string& file, const std::vector<std::string>& ignore_columns,
                           std::vector<std::string>& notes) {
  return SidecarReader(text, file, ignore_columns).read(notes);
}

}  // namespace musclesim
