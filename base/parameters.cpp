#include "musclesim/base/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <numeric>

#include "musclesim/base/error.h"
#include "toml_document.h"

namespace musclesim {

namespace {

std::string text(const Parameter::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return std::get<std::string>(value);
}

std::string withUnit(const std::string& value, const std::string& unit) {
  return unit.empty() ? value : value + " " + unit;
}

std::string allowedText(const Parameter& parameter) {
  if (!parameter.choices.empty()) return fmt::format("be one of {}", fmt::join(parameter.choices, ", "));
  const std::string kind = parameter.integer ? "be a whole number in" : "be a number in";
  return fmt::format("{} {} .. {}", kind, parameter.minimum, withUnit(fmt::format("{}", parameter.maximum), parameter.unit));
}

Parameter::Value parseValue(const std::string& written) {
  double number = 0;
  const char* begin = written.data();
  const char* end = begin + written.size();
  if (begin != end && *begin == '+') ++begin;
  const auto result = std::from_chars(begin, end, number);
  if (result.ec == std::errc() && result.ptr == end && begin != end) return number;
  return written;
}

/// Number of insertions, deletions and replacements of letters between two names (Levenshtein, 1966).
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearestName(const std::string& name, const std::vector<std::string>& names) {
  std::string nearest;
  std::size_t smallest = name.size() / 2 + 1;
  for (const auto& candidate : names) {
    // A name given without its group ("load_kg") is the nearest possible match.
    const bool is_tail = candidate.size() > name.size() && candidate.ends_with("." + name);
    const std::size_t distance = is_tail ? 0 : editDistance(name, candidate);
    if (distance < smallest) {
      smallest = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

const Parameter* Parameters::find(const std::string& name) const {
  const auto found = std::find_if(declared_.begin(), declared_.end(), [&](const Parameter& p) { return p.name == name; });
  return found == declared_.end() ? nullptr : &*found;
}

const Parameters::Override* Parameters::overrideOf(const std::string& name) const {
  const auto found = std::find_if(overrides_.begin(), overrides_.end(), [&](const Override& o) { return o.name == name; });
  return found == overrides_.end() ? nullptr : &*found;
}

void Parameters::refuse(const Override& given, const std::string& what) {
  if (!given.file.empty()) throw BadFile(given.file, given.line, 0, what);
  throw BadParameter(given.source.empty() ? what : given.source + ": " + what);
}

void Parameters::add(Override given) {
  if (given.name.empty()) refuse(given, "a parameter needs a name");
  for (auto& parameter : declared_) {
    if (parameter.name != given.name) continue;
    requireAllowed(parameter, given);
    parameter.value = given.value;
  }
  std::erase_if(overrides_, [&](const Override& o) { return o.name == given.name; });
  overrides_.push_back(std::move(given));
}

void Parameters::set(const std::string& name, const Parameter::Value& value, const std::string& source) {
  add({name, value, source});
}

void Parameters::setFromFile(const std::string& name, const Parameter::Value& value, const std::string& file, int line) {
  add({name, value, {}, file, line});
}

void Parameters::setAll(const Parameters& others) {
  for (const auto& given : others.overrides_) add(given);
}

void Parameters::setFromText(const std::string& assignment, const std::string& source) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw BadParameter(fmt::format("{} {}: must have the form name=value", source, assignment));
  set(assignment.substr(0, equals), parseValue(assignment.substr(equals + 1)), source);
}

void Parameters::readToml(const std::string& file) {
  const toml::table table = musclesim::readToml(file);
  const std::function<void(const toml::table&, const std::string&)> readTable = [&](const toml::table& entries, const std::string& prefix) {
    for (const auto& [key, node] : entries) {
      const std::string name = prefix + std::string(key.str());
      const auto line = static_cast<int>(node.source().begin.line);
      if (const auto* nested = node.as_table()) {
        readTable(*nested, name + ".");
      } else if (const auto value = node.value<double>(); value && !node.is_boolean()) {
        setFromFile(name, *value, file, line);
      } else if (const auto word = node.value<std::string>()) {
        setFromFile(name, *word, file, line);
      } else {
        throw BadFile(file, line, static_cast<int>(node.source().begin.column), name + ": must be a number or a string");
      }
    }
  };
  readTable(table, "");
}

bool Parameters::allows(const Parameter& parameter, const Parameter::Value& value) {
  if (const auto* number = std::get_if<double>(&value))
    return parameter.choices.empty() && std::isfinite(*number) && *number >= parameter.minimum && *number <= parameter.maximum &&
           (!parameter.integer || *number == std::round(*number));
  return std::ranges::find(parameter.choices, std::get<std::string>(value)) != parameter.choices.end();
}

void Parameters::requireAllowed(const Parameter& parameter, const Override& given) {
  if (allows(parameter, given.value)) return;
  const bool is_number = std::holds_alternative<double>(given.value);
  const std::string written = is_number ? withUnit(text(given.value), parameter.unit) : text(given.value);
  refuse(given, fmt::format("{} = {}: must {}", parameter.name, written, allowedText(parameter)));
}

const Parameter& Parameters::declare(Parameter parameter) {
  if (const auto* known = find(parameter.name)) return *known;
  requireAllowed(parameter, {parameter.name, parameter.default_value, "default"});
  parameter.value = parameter.default_value;
  if (const auto* given = overrideOf(parameter.name)) {
    requireAllowed(parameter, *given);
    parameter.value = given->value;
  }
  declared_.push_back(std::move(parameter));
  return declared_.back();
}

double Parameters::number(const std::string& name, double default_value, const std::string& unit, double minimum, double maximum,
                          const std::string& description) {
  return std::get<double>(declare({name, {}, default_value, unit, minimum, maximum, {}, false, description}).value);
}

int Parameters::integer(const std::string& name, int default_value, int minimum, int maximum, const std::string& description) {
  const auto as_double = static_cast<double>(default_value);
  return static_cast<int>(std::get<double>(
      declare({name, {}, as_double, "", static_cast<double>(minimum), static_cast<double>(maximum), {}, true, description}).value));
}

std::string Parameters::choice(const std::string& name, const std::string& default_value, const std::vector<std::string>& choices,
                               const std::string& description) {
  return std::get<std::string>(declare({name, {}, default_value, "", 0, 0, choices, false, description}).value);
}

std::string Parameters::unknownText(const std::string& name) const {
  std::vector<std::string> names;
  for (const auto& parameter : declared_) names.push_back(parameter.name);
  const std::string nearest = nearestName(name, names);
  return fmt::format("there is no parameter \"{}\" in this run{} (musclesim --print-config lists all; add --robot for another robot)", name,
                     nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?");
}

void Parameters::requireAllKnown() const {
  for (const auto& given : overrides_)
    if (!find(given.name)) refuse(given, unknownText(given.name));
}

std::vector<std::string> Parameters::dropUnknownOfFiles(const std::vector<std::string>& groups) {
  std::vector<std::string> dropped;
  std::erase_if(overrides_, [&](const Override& given) {
    const std::string group = given.name.substr(0, given.name.find('.'));
    if (given.file.empty() || find(given.name) || std::ranges::find(groups, group) == groups.end()) return false;
    dropped.push_back(given.name);
    return true;
  });
  return dropped;
}

void Parameters::requireScalable(const std::string& name) const {
  const Parameter* parameter = find(name);
  if (!parameter) throw BadParameter("tolerance: " + unknownText(name));
  if (!parameter->choices.empty() || parameter->integer)
    throw BadParameter(fmt::format("{} = {}: must be a number that can be off by a share of itself to have a tolerance, not {}", name,
                                   text(parameter->value), parameter->integer ? "a whole number" : "a choice"));
  if (std::get<double>(parameter->value) == 0)
    throw BadParameter(fmt::format("{} = 0: must not be 0 to have a tolerance, which is a share of it", name));
}

std::string Parameters::toToml() const {
  std::vector<std::string> groups;
  auto groupOf = [](const std::string& name) {
    const auto dot = name.rfind('.');
    return dot == std::string::npos ? std::string() : name.substr(0, dot);
  };
  for (const auto& parameter : declared_) {
    const auto group = groupOf(parameter.name);
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  std::string out;
  for (const auto& group : groups) {
    out += fmt::format("{}[{}]\n", out.empty() ? "" : "\n", group);
    for (const auto& parameter : declared_) {
      if (groupOf(parameter.name) != group) continue;
      const std::string key = group.empty() ? parameter.name : parameter.name.substr(group.size() + 1);
      const bool is_word = std::holds_alternative<std::string>(parameter.value);
      const std::string value = is_word ? '"' + text(parameter.value) + '"' : text(parameter.value);
      const std::string range = parameter.choices.empty() ? fmt::format("{} .. {}", parameter.minimum,
                                                                        withUnit(fmt::format("{}", parameter.maximum), parameter.unit))
                                                          : fmt::format("{}", fmt::join(parameter.choices, " | "));
      out += fmt::format("{} = {}  # {}; {}; default {}\n", key, value, parameter.description, range, text(parameter.default_value));
    }
  }
  return out;
}

}  // namespace musclesim
