#include "columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "musclesim/base/error.h"
#include "musclesim/base/text.h"
#include "musclesim/base/units.h"
#include "musclesim/log/csv.h"

namespace musclesim {

namespace {

/// The part of a name between the quantity and the unit.
enum class Component { none, muscle, joint, axis, own_name };

struct Unit {
  std::string_view name;
  double factor = 1;
  FullScale full_scale = FullScale::none;
};

/// The first unit is the canonical unit. The unit of a fraction has no name.
struct Quantity {
  std::string_view name;
  Component component;
  std::vector<Unit> units;
};

const std::vector<Quantity>& quantities() {
  const std::vector<Unit> lengths = {{"mm"}, {"cm", mm_per_cm}, {"m", mm_per_m}};
  const std::vector<Unit> pressures = {{""},
                                       {"kPa", 1, FullScale::pressure_kPa},
                                       {"bar", kPa_per_bar, FullScale::pressure_kPa},
                                       {"MPa", kPa_per_MPa, FullScale::pressure_kPa}};
  std::vector<Unit> commands = pressures;
  commands.push_back({"V", 1, FullScale::command_V});
  static const std::vector<Quantity> all = {
      {"time", Component::none, {{"s"}}},
      {"command", Component::muscle, commands},
      {"pressure", Component::muscle, pressures},
      {"force", Component::muscle, {{"N"}}},
      {"length", Component::muscle, lengths},
      {"angle", Component::joint, {{"deg"}, {"rad", deg_per_rad}}},
      {"hand", Component::axis, lengths},
      {"target", Component::axis, lengths},
      {"activity", Component::none, {{""}}},
      {"target", Component::joint, {{"deg"}, {"rad", deg_per_rad}}},
      {"controller", Component::own_name, {{""}}},
      // Velocities and accelerations of what has these names.
      {"length", Component::muscle, {{"mm_per_s"}}},
      {"length", Component::muscle, {{"mm_per_s2"}}},
      {"angle", Component::joint, {{"deg_per_s"}}},
      {"angle", Component::joint, {{"deg_per_s2"}}},
      {"hand", Component::axis, {{"mm_per_s"}}},
      {"hand", Component::axis, {{"mm_per_s2"}}},
  };
  return all;
}

std::string placeholder(Component component) {
  switch (component) {
    case Component::muscle:
      return "_<i>";
    case Component::joint:
      return "_<joint>";
    case Component::axis:
      return "_x|y|z";
    case Component::own_name:
      return "_<name>";
    default:
      return "";
  }
}

/// "length_<i>_mm|cm|m", "command_<i>[_kPa|bar|MPa|V]".
std::string pattern(const Quantity& quantity) {
  const bool has_fraction = quantity.units.front().name.empty();
  std::string units;
  for (const auto& unit : quantity.units)
    if (!unit.name.empty()) units += fmt::format("{}{}", units.empty() ? "" : "|", unit.name);
  std::string suffix = units.empty() ? "" : "_" + units;
  if (has_fraction && !units.empty()) suffix = "[" + suffix + "]";
  return std::string(quantity.name) + placeholder(quantity.component) + suffix;
}

std::string allPatterns() {
  std::string out;
  for (const auto& quantity : quantities()) out += (out.empty() ? "" : ", ") + pattern(quantity);
  return out;
}

/// "did you mean" with the valid name that is nearest to an unknown name.
std::string suggestion(const std::string& name) {
  constexpr std::size_t longest = 60;
  if (name.size() > longest) return "";
  const auto digits_begin = std::find_if(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
  const auto digits_end = std::find_if(digits_begin, name.end(), [](char c) { return c < '0' || c > '9'; });
  const std::string index = digits_begin == name.end() ? "0" : std::string(digits_begin, digits_end);
  std::vector<std::string> candidates;
  for (const auto& quantity : quantities()) {
    std::vector<std::string> components = {""};
    if (quantity.component == Component::muscle) components = {"_" + index};
    if (quantity.component == Component::joint) components = {"_elbow", "_wrist"};
    if (quantity.component == Component::axis) components = {"_x", "_y", "_z"};
    for (const auto& component : components)
      for (const auto& unit : quantity.units)
        candidates.push_back(std::string(quantity.name) + component + (unit.name.empty() ? "" : "_" + std::string(unit.name)));
  }
  const std::string nearest = nearestName(name, candidates);
  return nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest);
}

/// A muscle index in a name: a whole number without sign or leading zero.
std::optional<int> muscleIndex(std::string_view text) {
  constexpr std::size_t longest = 3;
  if (text.empty() || text.size() > longest || (text.size() > 1 && text[0] == '0')) return std::nullopt;
  int index = 0;
  for (const char digit : text) {
    if (digit < '0' || digit > '9') return std::nullopt;
    index = index * 10 + (digit - '0');
  }
  if (index > largest_muscle_index) return std::nullopt;
  return index;
}

bool isName(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; };
  return !text.empty() && text.front() != '_' && text.back() != '_' && std::all_of(text.begin(), text.end(), is_letter);
}

bool isComponent(Component kind, std::string_view text) {
  switch (kind) {
    case Component::muscle:
      return muscleIndex(text).has_value();
    case Component::joint:
    case Component::own_name:
      return isName(text);
    case Component::axis:
      return text == "x" || text == "y" || text == "z";
    default:
      return text.empty();
  }
}

Column columnOf(const Quantity& quantity, std::string_view component, const Unit& unit) {
  const std::string_view canonical_unit = quantity.units.front().name;
  Column column;
  column.name = std::string(quantity.name) + (component.empty() ? "" : "_" + std::string(component)) +
                (canonical_unit.empty() ? "" : "_" + std::string(canonical_unit));
  column.quantity = quantity.name;
  if (quantity.component == Component::muscle) column.muscle = *muscleIndex(component);
  column.unit = unit.name;
  column.canonical_unit = canonical_unit;
  column.factor = unit.factor;
  column.full_scale = unit.full_scale;
  return column;
}

/// `rest` is what follows the quantity: "_<component>_<unit>" with either part possibly missing.
std::optional<Column> matchRest(const Quantity& quantity, std::string_view rest) {
  for (const auto& unit : quantity.units) {
    std::string_view component = rest;
    if (!unit.name.empty()) {
      if (!component.ends_with(unit.name)) continue;
      component.remove_suffix(unit.name.size());
      if (!component.ends_with('_')) continue;
      component.remove_suffix(1);
    }
    if (quantity.component != Component::none) {
      if (!component.starts_with('_')) continue;
      component.remove_prefix(1);
    }
    if (isComponent(quantity.component, component)) return columnOf(quantity, component, unit);
  }
  return std::nullopt;
}

}  // namespace

Column parseColumnName(const std::string& name) {
  if (name.empty()) throw BadParameter("a column has no name; allowed: " + allPatterns());
  const std::string_view quantity_name = std::string_view(name).substr(0, name.find('_'));
  std::string patterns;  // of all quantities of this name
  for (const auto& quantity : quantities()) {
    if (quantity.name != quantity_name) continue;
    if (auto column = matchRest(quantity, std::string_view(name).substr(quantity_name.size()))) return *column;
    patterns += (patterns.empty() ? "" : ", ") + pattern(quantity);
  }
  if (!patterns.empty())
    throw BadParameter(fmt::format("column {}: unknown unit or component; allowed: {}{}", inQuotes(name), patterns, suggestion(name)));
  throw BadParameter(fmt::format("column {}: unknown quantity; allowed: {}{}", inQuotes(name), allPatterns(), suggestion(name)));
}

Column parseCanonicalName(const std::string& name) {
  const Column column = parseColumnName(name);
  if (column.name != name) throw BadParameter(fmt::format("column {}: must be in the canonical unit: {}", inQuotes(name), column.name));
  return column;
}

int requireCommands(const std::vector<Column>& columns) {
  std::set<int> commanded;
  for (const auto& column : columns)
    if (column.quantity == "command") commanded.insert(column.muscle);
  if (commanded.empty()) throw BadParameter("there is no column command_0: every muscle needs its command, command_0, command_1, ...");
  const auto count = static_cast<int>(commanded.size());
  if (*commanded.rbegin() != count - 1) {
    int missing = 0;
    while (commanded.contains(missing)) ++missing;
    throw BadParameter(
        fmt::format("there is no column command_{} although there is command_{}: the muscles' commands must be numbered from 0 "
                    "without gaps",
                    missing, *commanded.rbegin()));
  }
  for (const auto& column : columns)
    if (column.muscle >= count)
      throw BadParameter(
          fmt::format("column {} belongs to a muscle without command: the commands are command_0 .. command_{}", column.name, count - 1));
  return count;
}

double fullScale(const Column& column, const RecordingInfo& info) {
  if (column.full_scale == FullScale::none) return 1;
  const bool is_voltage = column.full_scale == FullScale::command_V;
  const auto& value = is_voltage ? info.command_full_scale_V : info.pressure_full_scale_kPa;
  if (value) return *value;
  const std::string member = is_voltage ? "command_full_scale_V" : "pressure_full_scale_kPa";
  throw BadParameter(fmt::format("{}_{}_{}: {} can be converted to fractions only if the sidecar gives \"{}\"", column.quantity,
                                 column.muscle, column.unit, column.unit, member));
}

}  // namespace musclesim
