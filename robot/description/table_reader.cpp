#include "table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "musclesim/base/error.h"
#include "musclesim/base/parameters.h"

namespace musclesim::description {

void FilePlace::refuse(const std::string& problem) const {
  throw BadFile(file, line, column, what.empty() ? problem : what + ": " + problem);
}

namespace {

/// How the file has a value, for messages.
std::string shown(const toml::node& node) {
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  constexpr std::size_t longest = 60;
  return text.str().size() > longest ? text.str().substr(0, longest) + " ..." : text.str();
}

}  // namespace

void requireShort(const std::string& expression, const FilePlace& place) {
  constexpr std::size_t longest = 1000;  // far above what people write; keeps nesting and messages short
  if (expression.size() > longest)
    place.refuse(fmt::format("the expression has {} characters: must have {} at most", expression.size(), longest));
}

TableReader::TableReader(const toml::table& table, std::string file, std::string what)
    : table_(&table), file_(std::move(file)), what_(std::move(what)) {}

FilePlace TableReader::place(const std::string& key) const {
  const toml::node* node = key.empty() ? nullptr : table_->get(key);
  return placeOf(node ? *node : *table_, key);
}

FilePlace TableReader::placeOf(const toml::node& node, const std::string& key) const {
  const auto begin = node.source().begin;
  std::string what = what_;
  if (!key.empty()) what += what.empty() ? key : ": " + key;
  return {file_, static_cast<int>(begin.line), static_cast<int>(begin.column), what};
}

const toml::node* TableReader::find(const std::string& key) {
  if (std::ranges::find(asked_, key) == asked_.end()) asked_.push_back(key);
  return table_->get(key);
}

const toml::node& TableReader::need(const std::string& key, const std::string& kind) {
  const toml::node* node = find(key);
  if (!node) place().refuse(fmt::format("\"{}\" is missing: must be {}", key, kind));
  return *node;
}

bool TableReader::has(const std::string& key) {
  return find(key) != nullptr;
}

bool TableReader::isTable(const std::string& key) const {
  const toml::node* node = table_->get(key);
  return node && node->is_table();
}

std::string TableReader::text(const std::string& key) {
  const toml::node& node = need(key, "a text");
  const auto text = node.value_exact<std::string>();
  if (!text) placeOf(node, key).refuse(shown(node) + " must be a text in quotes");
  return *text;
}

std::optional<std::string> TableReader::optionalText(const std::string& key) {
  return find(key) ? std::optional(text(key)) : std::nullopt;
}

std::string TableReader::choice(const std::string& key, const std::string& default_value, const std::vector<std::string>& allowed) {
  if (!find(key) && !default_value.empty()) return default_value;
  if (!find(key)) place().refuse(fmt::format("\"{}\" is missing: must be one of {}", key, fmt::join(allowed, ", ")));
  const std::string given = text(key);
  if (std::ranges::find(allowed, given) == allowed.end()) {
    const std::string nearest = nearestName(given, allowed);
    place(key).refuse(fmt::format("\"{}\" must be one of {}{}", given, fmt::join(allowed, ", "),
                                  nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
  }
  return given;
}

bool TableReader::flag(const std::string& key, bool default_value) {
  const toml::node* node = find(key);
  if (!node) return default_value;
  if (!node->is_boolean()) placeOf(*node, key).refuse(shown(*node) + " must be true or false");
  return *node->value<bool>();
}

Quantity TableReader::quantityOf(const toml::node& node, const std::string& key) const {
  Quantity result{.number = 0, .expression = {}, .place = placeOf(node, key)};
  if (node.is_string()) {
    result.expression = *node.value<std::string>();
    if (result.expression.empty()) result.place.refuse("\"\" must be a number or an expression over the file's parameters");
    requireShort(result.expression, result.place);
    return result;
  }
  if (!node.is_number()) result.place.refuse(shown(node) + " must be a number or an expression over the file's parameters, in quotes");
  result.number = node.value<double>().value_or(std::nan(""));
  if (!std::isfinite(result.number)) result.place.refuse(shown(node) + " must be finite");
  return result;
}

double TableReader::number(const std::string& key) {
  const Quantity quantity = quantityOf(need(key, "a number"), key);
  if (!quantity.expression.empty()) quantity.place.refuse("\"" + quantity.expression + "\" must be a plain number");
  return quantity.number;
}

std::pair<double, double> TableReader::range(const std::string& key) {
  const toml::node& node = need(key, "[least, greatest]");
  const auto [low, high] = listOf<2>(node, key);
  if (!low.expression.empty() || !high.expression.empty()) placeOf(node, key).refuse(shown(node) + " must be two plain numbers");
  if (!(low.number < high.number)) placeOf(node, key).refuse(shown(node) + " must be in order, the least first");
  return {low.number, high.number};
}

Quantity TableReader::quantity(const std::string& key) {
  return quantityOf(need(key, "a number or an expression over the file's parameters"), key);
}

std::optional<Quantity> TableReader::optionalQuantity(const std::string& key) {
  return find(key) ? std::optional(quantity(key)) : std::nullopt;
}

template <std::size_t count>
std::array<Quantity, count> TableReader::listOf(const toml::node& node, const std::string& key) const {
  const toml::array* list = node.as_array();
  if (!list || list->size() != count)
    placeOf(node, key).refuse(fmt::format("{} must be a list of {} numbers or expressions", shown(node), count));
  std::array<Quantity, count> result;
  for (std::size_t i = 0; i < count; ++i) result[i] = quantityOf(*list->get(i), key);
  return result;
}

QuantityVector TableReader::axisOf(const toml::node& node, const std::string& key) const {
  if (!node.is_string()) return listOf<3>(node, key);
  const std::string letter = *node.value<std::string>();
  if (letter != "x" && letter != "y" && letter != "z")
    placeOf(node, key).refuse("\"" + letter + "\" must be \"x\", \"y\", \"z\" or a vector of three numbers");
  QuantityVector axis;
  for (Quantity& component : axis) component.place = placeOf(node, key);
  axis[static_cast<std::size_t>(letter[0] - 'x')].number = 1;
  return axis;
}

QuantityVector TableReader::vector(const std::string& key) {
  return listOf<3>(need(key, "a vector of three numbers or expressions"), key);
}

QuantityVector TableReader::direction(const std::string& key) {
  return axisOf(need(key, "\"x\", \"y\", \"z\" or a vector of three numbers or expressions"), key);
}

std::optional<QuantityVector> TableReader::optionalDirection(const std::string& key) {
  return find(key) ? std::optional(direction(key)) : std::nullopt;
}

std::optional<QuantityVector> TableReader::optionalVector(const std::string& key) {
  return find(key) ? std::optional(vector(key)) : std::nullopt;
}

std::vector<QuantityVector> TableReader::vectors(const std::string& key) {
  const toml::node& node = need(key, "a list of points");
  if (!node.is_array()) placeOf(node, key).refuse(shown(node) + " must be a list of points, each three numbers or expressions");
  std::vector<QuantityVector> result;
  for (const toml::node& entry : *node.as_array()) result.push_back(listOf<3>(entry, key));
  return result;
}

std::optional<std::array<Quantity, 2>> TableReader::optionalPair(const std::string& key) {
  const toml::node* node = find(key);
  return node ? std::optional(listOf<2>(*node, key)) : std::nullopt;
}

std::vector<Quantity> TableReader::quantities(const std::string& key) {
  std::vector<Quantity> result;
  const toml::node* node = find(key);
  if (!node) return result;
  if (!node->is_array()) placeOf(*node, key).refuse(shown(*node) + " must be a list of numbers or expressions");
  for (const toml::node& entry : *node->as_array()) result.push_back(quantityOf(entry, key));
  return result;
}

std::vector<std::pair<Quantity, QuantityVector>> TableReader::turns(const std::string& key) {
  std::vector<std::pair<Quantity, QuantityVector>> result;
  const toml::node* node = find(key);
  if (!node) return result;
  constexpr const char* form = " must be a list of turns [angle, axis], for example [[90, \"x\"]]";
  if (!node->is_array()) placeOf(*node, key).refuse(shown(*node) + form);
  for (const toml::node& entry : *node->as_array()) {
    const toml::array* turn = entry.as_array();
    if (!turn || turn->size() != 2) placeOf(entry, key).refuse(shown(entry) + form);
    result.emplace_back(quantityOf(*turn->get(0), key), axisOf(*turn->get(1), key));
  }
  return result;
}

TableReader TableReader::table(const std::string& key) {
  const toml::node& node = need(key, "a table");
  if (!node.is_table()) placeOf(node, key).refuse(shown(node) + " must be a table, for example { key = value }");
  return {*node.as_table(), file_, what_.empty() ? "[" + key + "]" : what_ + ": " + key};
}

std::optional<TableReader> TableReader::optionalTable(const std::string& key) {
  return find(key) ? std::optional(table(key)) : std::nullopt;
}

std::vector<TableReader> TableReader::tables(const std::string& key) {
  std::vector<TableReader> result;
  const toml::node* node = find(key);
  if (!node) return result;
  if (!node->is_array()) placeOf(*node, key).refuse(fmt::format("must be a list of tables: write [[{}]] above each", key));
  for (const toml::node& entry : *node->as_array()) {
    if (!entry.is_table()) placeOf(entry, key).refuse(shown(entry) + " must be a table");
    result.push_back({*entry.as_table(), file_, what_.empty() ? "[[" + key + "]]" : what_ + ": " + key});
  }
  return result;
}

std::vector<std::string> TableReader::keys() const {
  std::vector<std::string> result;
  for (const auto& [key, node] : *table_) result.emplace_back(key.str());
  return result;
}

void TableReader::requireNoOthers() const {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::ranges::find(asked_, name) != asked_.end()) continue;
    const std::string nearest = nearestName(name, asked_);
    FilePlace at = placeOf(node, "");
    at.line = static_cast<int>(key.source().begin.line);
    at.column = static_cast<int>(key.source().begin.column);
    at.refuse(fmt::format("there is no \"{}\"{}; known: {}", name, nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?",
                          fmt::join(asked_, ", ")));
  }
}

}  // namespace musclesim::description
