#include "collect.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "musclesim/base/file.h"
#include "result.h"
#include "sweep.h"

namespace musclesim {

namespace {

using nlohmann::ordered_json;

/// A number or text with its dotted name.
struct Number {
  std::string name;
  ordered_json value;
  bool of_machine;  ///< depends on the machine: a wall time or a path
};
using Flat = std::vector<Number>;

bool dependsOnTheMachine(const std::string& member) {
  for (const char* name : {"wall_s", "real_time_factor", "elapsed_s", "log", "figure", "out"})
    if (member == name) return true;
  return false;
}

void flatten(const ordered_json& json, const std::string& prefix, bool with_lists, bool of_machine, Flat& flat) {
  const auto add = [&](const std::string& name, const ordered_json& value) {
    const bool is_of_machine = of_machine || (json.is_object() && dependsOnTheMachine(name));
    if (value.is_object() || (value.is_array() && with_lists))
      flatten(value, prefix + name + ".", with_lists, is_of_machine, flat);
    else if (!value.is_array())
      flat.push_back({prefix + name, value, is_of_machine});
  };
  if (json.is_array())
    for (std::size_t i = 0; i < json.size(); ++i) add(std::to_string(i), json[i]);
  else
    for (const auto& [name, value] : json.items()) add(name, value);
}

/// Selects the numbers to collect; remembers which patterns matched no number.
class Choice {
 public:
  explicit Choice(const std::vector<std::string>& columns) : all_(columns.empty()), unmet_(columns), columns_(columns) {}

  bool takes(const Number& number) {
    if (all_) return !number.of_machine;
    bool taken = false;
    for (const std::string& column : columns_) {
      if (!matches(column, number)) continue;
      std::erase(unmet_, column);
      taken = true;
    }
    return taken;
  }

  const std::vector<std::string>& unmet() const { return unmet_; }

 private:
  /// Wall times and paths are collected only if a pattern gives their full name.
  static bool matches(const std::string& column, const Number& number) {
    if (!column.ends_with('*')) return number.name == column;
    return !number.of_machine && number.name.starts_with(column.substr(0, column.size() - 1));
  }

  bool all_;
  std::vector<std::string> unmet_, columns_;
};

/// A CSV cell, in quotes if necessary (RFC 4180).
std::string cell(const ordered_json& value) {
  if (value.is_null()) return {};
  if (!value.is_string()) return value.dump();
  std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  for (auto quote = text.find('"'); quote != std::string::npos; quote = text.find('"', quote + 2)) text.insert(quote, 1, '"');
  return '"' + text + '"';
}

/// The rows of the table. Columns are in the order of their first appearance.
class Table {
 public:
  void add(const ordered_json& row) {
    for (const auto& [name, value] : row.items())
      if (known_.emplace(name, columns_.size()).second) columns_.push_back(name);
    rows_.push_back(row);
  }

  std::string csv() const {
    std::string text;
    for (std::size_t i = 0; i < columns_.size(); ++i) text += (i ? "," : "") + cell(columns_[i]);
    for (const auto& row : rows_) {
      text += '\n';
      for (std::size_t i = 0; i < columns_.size(); ++i) text += (i ? "," : "") + (row.contains(columns_[i]) ? cell(row[columns_[i]]) : "");
    }
    return text + '\n';
  }

  const std::vector<ordered_json>& rows() const { return rows_; }

 private:
  std::vector<std::string> columns_;
  std::map<std::string, std::size_t> known_;
  std::vector<ordered_json> rows_;
};

ordered_json tableRow(const Sweep& sweep, std::size_t number, const RowResult* result, Choice& choice) {
  ordered_json row = {{"row", number}, {"status", result ? result->status : "missing"}};
  for (const auto& [name, value] : sweep.rows[number].parameters) row[name] = valueJson(value);
  if (!result) return row;
  if (!result->message.empty()) row["message"] = result->message;
  Flat flat;
  flatten(result->numbers, "", !sweep.columns.empty(), false, flat);
  for (const Number& entry : flat)
    if (choice.takes(entry)) row[row.contains(entry.name) || entry.name == "message" ? "result." + entry.name : entry.name] = entry.value;
  return row;
}

std::string jsonText(const Sweep& sweep, const Collected& collected, const Table& table) {
  const ordered_json head = {{"format", "musclesim-collected-1"}, {"program", sweep.program},
                             {"robots_hash", sweep.robots_hash},  {"complete", collected.complete()},
                             {"done", collected.done_count},      {"missing", collected.missing},
                             {"diverged", collected.diverged},    {"failed", collected.failed},
                             {"crashed", collected.crashed},      {"rows", table.rows()}};
  return head.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

Collected collect(const std::string& folder) {
  const Sweep sweep = readSweep(folder);
  Collected collected;
  collected.row_count = sweep.rows.size();
  Table table;
  Choice choice(sweep.columns);
  for (std::size_t row = 0; row < sweep.rows.size(); ++row) {
    if (!hasResult(folder, row)) {
      collected.missing.push_back(row);
      table.add(tableRow(sweep, row, nullptr, choice));
      continue;
    }
    const RowResult result = readResult(folder, row);
    collected.done_count += result.status == "done";
    if (result.status == "diverged") collected.diverged.push_back(row);
    if (result.status == "failed") collected.failed.push_back(row);
    if (result.status == "crashed") collected.crashed.push_back(row);
    table.add(tableRow(sweep, row, &result, choice));
  }
  if (collected.done_count > 0) collected.unmet_columns = choice.unmet();
  collected.csv_file = folder + "/collected.csv";
  collected.json_file = folder + "/collected.json";
  replaceFile(collected.csv_file, table.csv());
  replaceFile(collected.json_file, jsonText(sweep, collected, table));
  return collected;
}

}  // namespace musclesim
