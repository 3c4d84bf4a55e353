#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "../base/toml_document.h"
#include "musclesim/base/error.h"
#include "musclesim/log/import.h"

namespace musclesim {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Reads the members of one table and refuses unknown members.
class Members {
 public:
  Members(const toml::table& table, std::string file, std::string place)
      : table_(table), file_(std::move(file)), place_(std::move(place)) {}

  template <class Value>
  std::optional<Value> get(const std::string& name, const std::string& kind) {
    known_.push_back(name);
    const toml::node* node = table_.get(name);
    if (!node) return std::nullopt;
    const auto value = node->value<Value>();
    if (!value) refuse(*node, fmt::format("{}.{}: must be {}", place_, name, kind));
    return value;
  }
  std::optional<double> positive(const std::string& name) {
    const auto value = get<double>(name, "a number");
    if (value && !(*value > 0)) refuse(*table_.get(name), fmt::format("{}.{}: must be larger than 0", place_, name));
    return value;
  }
  void requireAllKnown() const {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (std::find(known_.begin(), known_.end(), name) == known_.end()) {
        const std::string nearest = nearestName(name, known_);
        refuse(node,
               fmt::format("{}: there is no member \"{}\"{}", place_, name, nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?"));
      }
    }
  }
  [[noreturn]] void refuse(const toml::node& node, const std::string& what) const {
    throw BadFile(file_, static_cast<int>(node.source().begin.line), static_cast<int>(node.source().begin.column), what);
  }
  void know(const std::string& name) { known_.push_back(name); }

 private:
  const toml::table& table_;
  std::string file_, place_;
  std::vector<std::string> known_;
};

ImportColumn readColumn(const std::string& name, const toml::node& node, const std::string& file) {
  ImportColumn column;
  column.name = name;
  column.minimum = -infinity;
  column.maximum = infinity;
  column.linear = !name.starts_with("command_");
  if (const auto from = node.value<std::string>()) {
    column.from = *from;
    return column;
  }
  const toml::table* table = node.as_table();
  if (!table)
    throw BadFile(file, static_cast<int>(node.source().begin.line), static_cast<int>(node.source().begin.column),
                  name + ": must be the name of a column or a table like { from = \"name\", factor = 2 }");
  Members members(*table, file, "columns." + name);
  const auto value = members.get<double>("value", "a number");
  column.from = members.get<std::string>("from", "a column's name").value_or("");
  column.table = members.get<std::string>("table", "a file's name").value_or("");
  column.time = members.get<std::string>("time", "a column's name").value_or(column.time);
  column.factor = members.get<double>("factor", "a number").value_or(1);
  column.offset = members.get<double>("offset", "a number").value_or(0);
  column.minimum = members.get<double>("minimum", "a number").value_or(column.minimum);
  column.maximum = members.get<double>("maximum", "a number").value_or(column.maximum);
  column.linear = members.get<bool>("linear", "true or false").value_or(column.linear);
  column.value = value.value_or(0);
  members.requireAllKnown();
  if (value.has_value() == !column.from.empty()) members.refuse(node, name + ": needs either from or value");
  return column;
}

void readRows(const toml::table& table, ImportMapping& mapping) {
  Members rows(table, mapping.file, "rows");
  mapping.settle_s = rows.positive("settle_s");
  mapping.step_s = rows.positive("step_s");
  mapping.before_s = rows.positive("before_s");
  mapping.from_s = rows.get<double>("from_s", "a number");
  mapping.until_s = rows.get<double>("until_s", "a number");
  mapping.every = static_cast<int>(rows.get<std::int64_t>("every", "a whole number").value_or(1));
  rows.know("before");
  rows.requireAllKnown();
  if (mapping.every < 1) rows.refuse(*table.get("every"), "rows.every: must be at least 1");
  if (const toml::node* before = table.get("before"); before && !mapping.before_s)
    rows.refuse(*before, "rows.before: needs rows.before_s, the time the plant rested");
  if (const toml::node* before = table.get("before"); before && !before->is_table())
    rows.refuse(*before, "rows.before: must be a table like { command_0 = 0 }");
  if (const toml::table* before = table["before"].as_table())
    for (const auto& [key, node] : *before) {
      const auto value = node.value<double>();
      if (!value) rows.refuse(node, fmt::format("rows.before.{}: must be a number", key.str()));
      mapping.before[std::string(key.str())] = *value;
    }
}

/// All members except columns and rows belong to the sidecar.
std::string sidecarJson(toml::table table) {
  table.erase("columns");
  table.erase("rows");
  table.insert_or_assign("format", "musclesim-recording-1");
  std::ostringstream text;
  text << toml::json_formatter(table);
  return text.str();
}

}  // namespace

ImportMapping readImportMapping(const std::string& toml_file) {
  const toml::table table = readToml(toml_file);
  ImportMapping mapping;
  mapping.file = toml_file;
  const toml::table* columns = table["columns"].as_table();
  if (!columns)
    throw BadFile(toml_file, "has no section [columns], which must say which column of the table each column of the recording comes from");
  for (const auto& [key, node] : *columns) mapping.columns.push_back(readColumn(std::string(key.str()), node, toml_file));
  if (const toml::node* rows = table.get("rows")) {
    if (!rows->is_table())
      throw BadFile(toml_file, static_cast<int>(rows->source().begin.line), static_cast<int>(rows->source().begin.column),
                    "rows: must be a table, [rows]");
    readRows(*rows->as_table(), mapping);
  }
  mapping.sidecar_json = sidecarJson(table);
  return mapping;
}

}  // namespace musclesim
