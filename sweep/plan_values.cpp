#include "plan_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"

namespace musclesim {

Parameter::Value Distribution::at(double unit) const {
  if (!choices.empty()) return choices[std::min(choices.size() - 1, static_cast<std::size_t>(unit * static_cast<double>(choices.size())))];
  if (integer) return std::min(high, std::floor(low + unit * (high - low + 1)));
  return log ? low * std::pow(high / low, unit) : low + unit * (high - low);
}

void PlanReader::refuse(const toml::node& node, const std::string& what) const {
  throw BadFile(file_, static_cast<int>(node.source().begin.line), static_cast<int>(node.source().begin.column), what);
}

std::string PlanReader::text(const toml::node& node, const std::string& name) const {
  const auto text = node.value_exact<std::string>();
  if (!text) refuse(node, name + ": must be a string");
  return *text;
}

double PlanReader::number(const toml::node& node, const std::string& name) const {
  if (!node.is_number()) refuse(node, name + ": must be a number");
  const auto number = node.value<double>();
  if (!number) refuse(node, name + ": must be at most 2^53, the limit up to which a double holds every whole number");
  if (!std::isfinite(*number)) refuse(node, name + ": must be finite");
  return *number;
}

std::size_t PlanReader::count(const toml::node& node, const std::string& name) const {
  const auto count = node.value_exact<std::int64_t>();
  if (!count || *count < 1 || *count > static_cast<std::int64_t>(most_sweep_rows))
    refuse(node, fmt::format("{}: must be a whole number in 1 .. {}", name, most_sweep_rows));
  return static_cast<std::size_t>(*count);
}

std::vector<std::string> PlanReader::texts(const toml::node& node, const std::string& name) const {
  if (!node.is_array()) refuse(node, name + ": must be a list of strings");
  std::vector<std::string> texts;
  for (const toml::node& entry : *node.as_array()) texts.push_back(text(entry, name));
  return texts;
}

Parameter::Value PlanReader::value(const toml::node& node, const std::string& name) const {
  if (node.is_string()) return text(node, name);
  if (!node.is_number()) refuse(node, name + ": must be a number or a string");
  return number(node, name);
}

std::vector<std::pair<std::string, PlanReader::Values>> PlanReader::lists(const toml::table& section, const std::string& prefix) const {
  std::vector<std::pair<std::string, Values>> lists;
  for (const auto& [key, node] : section) {
    const std::string name = prefix + std::string(key.str());
    if (const auto* nested = node.as_table()) {
      for (auto& list : this->lists(*nested, name + ".")) lists.push_back(std::move(list));
      continue;
    }
    if (!node.is_array() || node.as_array()->empty()) refuse(node, name + ": must be a list of values, [1, 2, 3]");
    Values values;
    for (const toml::node& entry : *node.as_array()) values.push_back(value(entry, name));
    lists.emplace_back(name, std::move(values));
  }
  return lists;
}

std::vector<std::pair<std::string, Parameter::Value>> PlanReader::constants(const toml::table& section, const std::string& prefix) const {
  std::vector<std::pair<std::string, Parameter::Value>> constants;
  for (const auto& [key, node] : section) {
    const std::string name = prefix + std::string(key.str());
    if (const auto* nested = node.as_table()) {
      for (auto& constant : this->constants(*nested, name + ".")) constants.push_back(std::move(constant));
    } else {
      constants.emplace_back(name, value(node, name));
    }
  }
  return constants;
}

Distribution PlanReader::distribution(const toml::table& entry, const std::string& name) const {
  Distribution result{name, 0, 1, false, false, {}};
  for (const auto& [key, node] : entry) {
    const std::string member = name + "." + std::string(key.str());
    if (key == "low") {
      result.low = number(node, member);
    } else if (key == "high") {
      result.high = number(node, member);
    } else if (key == "log" || key == "integer") {
      if (!node.is_boolean()) refuse(node, member + ": must be true or false");
      (key == "log" ? result.log : result.integer) = **node.as_boolean();
    } else if (key == "choices") {
      if (!node.is_array() || node.as_array()->empty()) refuse(node, member + ": must be a list of values");
      for (const toml::node& choice : *node.as_array()) result.choices.push_back(value(choice, member));
    } else {
      refuse(node, member + ": must be low, high, log, integer or choices");
    }
  }
  if (!result.choices.empty()) return result;
  if (!entry.contains("low") || !entry.contains("high") || !(result.low <= result.high))
    refuse(entry, name + ": must have low and high with low <= high, or choices");
  if (result.log && !(result.low > 0)) refuse(entry, name + ": log needs low > 0");
  if (result.integer && (result.log || result.low != std::floor(result.low) || result.high != std::floor(result.high)))
    refuse(entry, name + ": integer needs whole numbers low and high, and no log");
  return result;
}

std::vector<Distribution> PlanReader::distributions(const toml::table& section, const std::string& prefix) const {
  std::vector<Distribution> distributions;
  for (const auto& [key, node] : section) {
    const std::string name = prefix + std::string(key.str());
    if (prefix.empty() && key == "count") continue;
    if (!node.is_table()) refuse(node, name + ": must be a range, {low = 1, high = 5}, or {choices = [...]}");
    const toml::table& entry = *node.as_table();
    if (entry.contains("low") || entry.contains("high") || entry.contains("choices"))
      distributions.push_back(distribution(entry, name));
    else
      for (auto& nested : this->distributions(entry, name + ".")) distributions.push_back(std::move(nested));
  }
  return distributions;
}

}  // namespace musclesim
