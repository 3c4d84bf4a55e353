#include "musclesim/log/import_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../base/toml_document.h"
#include "musclesim/base/error.h"
#include "reading_units.h"
#include "sidecar.h"

namespace musclesim {

namespace {

constexpr std::array<std::string_view, 4> own_sections = {"columns", "rows", "table", "tables"};
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

/// The clock of another table without word of it.
TableClock plainClock() {
  TableClock clock;
  clock.from.name = "time_s";
  return clock;
}

constexpr const char* column_kind = "a column's name or its number, from 1";

/// A column by name or number.
ColumnName columnName(const Members& members, const toml::node& node, const std::string& place) {
  if (const auto name = node.value<std::string>(); name && !name->empty()) return {*name, 0};
  const auto number = node.is_integer() ? node.value<int>() : std::nullopt;
  if (!number || *number < 1) members.refuse(node, fmt::format("{}: must be {}", place, column_kind));
  return {"", *number};
}

ColumnName columnMember(Members& members, const toml::table& table, const std::string& name) {
  members.know(name);
  const toml::node* node = table.get(name);
  return node ? columnName(members, *node, name) : ColumnName{};
}

/// A clock: a column, or a table. `unit_s`: the unit in which factor and offset are.
TableClock readClock(const toml::node& node, const std::string& place, double unit_s, const std::string& file) {
  TableClock clock;
  clock.factor = unit_s;
  static const toml::table none;
  const toml::table* table = node.as_table();
  Members members(table ? *table : none, file, place);
  if (!table) {
    clock.from = columnName(members, node, place);
    return clock;
  }
  clock.from = columnMember(members, *table, "from");
  clock.date = columnMember(members, *table, "date");
  clock.format = members.get<std::string>("format", "a format like \"%Y-%m-%d %H:%M:%S\"").value_or("");
  const auto rate_Hz = members.positive("rate_Hz");
  const auto factor = members.get<double>("factor", "a number");
  clock.factor = factor.value_or(1) * unit_s;
  if (rate_Hz) clock.factor = 1 / *rate_Hz;
  clock.offset = members.get<double>("offset", "a number").value_or(0) * unit_s;
  clock.wraps_at_s = members.positive("wraps_at_s").value_or(0);
  members.requireAllKnown();
  if (rate_Hz && factor) members.refuse(node, place + ": rate_Hz and factor cannot both be given");
  if (clock.from.empty() && !rate_Hz) members.refuse(node, place + ": needs from, a column, or rate_Hz, the rows per second");
  if (!clock.date.empty() && clock.format.empty()) clock.format = "%Y-%m-%d %H:%M:%S";
  return clock;
}

/// The clock that a table's members give as time_s, time_ms, time_us or time_min.
std::optional<TableClock> clockMember(Members* members, const toml::table& table, const std::string& file) {
  std::optional<TableClock> clock;
  for (const ReadingUnit& unit : readingUnits()) {
    if (unit.quantity != "time") continue;
    const std::string name = fmt::format("time_{}", unit.name);
    if (members) members->know(name);
    const toml::node* node = table.get(name);
    if (!node) continue;
    if (clock)
      throw BadFile(file, static_cast<int>(node->source().begin.line), static_cast<int>(node->source().begin.column),
                    name + ": the time is given twice, in two units");
    clock = readClock(*node, name, unit.factor, file);
  }
  return clock;
}

/// An absolute pressure becomes a gauge pressure.
void subtractAmbient(ImportColumn& column, Members& members, const toml::node& node) {
  const auto ambient_kPa = members.positive("ambient_kPa");
  if (!ambient_kPa) return;
  const ReadingUnit* unit = unitAtEnd(column.written);
  if (!unit || unit->quantity != "pressure")
    members.refuse(node, column.written + ": ambient_kPa needs a column in a unit of pressure, for example pressure_0_hPa");
  column.offset -= *ambient_kPa / unit->factor;
}

void readOwnClock(ImportColumn& column, Members& members, const toml::table& table, const std::string& file) {
  members.know("time");
  const toml::node* time = table.get("time");
  if (time) column.clock = readClock(*time, column.written + ".time", 1, file);
  const auto factor = members.get<double>("time_factor", "a number"), offset = members.get<double>("time_offset", "a number");
  if (!factor && !offset) return;
  if (column.table.empty() && !time) members.refuse(table, column.written + ": time_factor and time_offset need table or time");
  if (!column.clock) column.clock = plainClock();
  column.clock->factor *= factor.value_or(1);
  column.clock->offset = column.clock->offset * factor.value_or(1) + offset.value_or(0);
}

void readLimits(ImportColumn& column, Members& members, const toml::table& table) {
  column.clipped_below = members.get<double>("clipped_below", "a number");
  column.clipped_above = members.get<double>("clipped_above", "a number");
  if (!column.clipped_below && !column.clipped_above) return;
  if (column.name.starts_with("command_") || column.from.empty())
    members.refuse(table,
                   column.written + ": clipped_below and clipped_above are limits of a sensor, which commands and constants do not have");
  if (column.clipped_below && column.clipped_above && *column.clipped_below >= *column.clipped_above)
    members.refuse(table, column.written + ": clipped_below must be less than clipped_above");
}

void readUnwrap(ImportColumn& column, Members& members, const toml::table& table) {
  column.unwrap = members.get<double>("unwrap", "a number");
  if (!column.unwrap) return;
  if (!(*column.unwrap > 0))
    members.refuse(table, fmt::format("{}: unwrap = {:g} must be positive: 360 for degrees", column.written, *column.unwrap));
  if (column.name.starts_with("command_") || column.from.empty())
    members.refuse(table, column.written + ": unwrap is for a sensor that begins again, which commands and constants do not");
}

ImportColumn readColumn(const std::string& name, const toml::node& node, const std::string& file) {
  if (const auto from = node.value<std::string>()) return importColumn(name, {*from, 0});
  ImportColumn column = importColumn(name, {});
  const toml::table* table = node.as_table();
  if (!table)
    throw BadFile(file, static_cast<int>(node.source().begin.line), static_cast<int>(node.source().begin.column),
                  name + ": must be the name of a column or a table like { from = \"name\", factor = 2 }");
  Members members(*table, file, "columns." + name);
  const auto value = members.get<double>("value", "a number");
  column.from = columnMember(members, *table, "from");
  column.table = members.get<std::string>("table", "a file's name").value_or("");
  readOwnClock(column, members, *table, file);
  column.factor = members.get<double>("factor", "a number").value_or(1);
  column.offset = members.get<double>("offset", "a number").value_or(0);
  column.minimum = members.get<double>("minimum", "a number").value_or(column.minimum);
  column.maximum = members.get<double>("maximum", "a number").value_or(column.maximum);
  readLimits(column, members, *table);
  readUnwrap(column, members, *table);
  column.linear = members.get<bool>("linear", "true or false").value_or(column.linear);
  subtractAmbient(column, members, node);
  column.value = value.value_or(0);
  members.requireAllKnown();
  if (value.has_value() == !column.from.empty()) members.refuse(node, name + ": needs either from or value");
  return column;
}

/// One of the characters that `allowed` has.
void readCharacter(Members& members, const toml::table& table, const std::string& name, std::string_view allowed, char& character) {
  const auto text = members.get<std::string>(name, "a character");
  if (!text) return;
  if (text->size() != 1 || allowed.find(*text) == std::string_view::npos)
    members.refuse(*table.get(name),
                   fmt::format("{}: must be one of the characters {}", name,
                               allowed.front() == ',' ? "\",\", \";\", \"|\", \" \" (any number of blanks) or \"\\t\"" : "\".\" or \",\""));
  character = text->front();
}

int countMember(Members& members, const toml::table& table, const std::string& name, int default_count) {
  const auto count = members.get<std::int64_t>(name, "a whole number");
  constexpr std::int64_t most = 1'000'000;
  if (count && (*count < 0 || *count > most)) members.refuse(*table.get(name), fmt::format("{}: must lie in 0 .. {}", name, most));
  return static_cast<int>(count.value_or(default_count));
}

void readMissing(Members& members, const toml::table& table, TableFormat& format) {
  members.know("missing");
  const toml::node* node = table.get("missing");
  if (!node) return;
  const toml::array* words = node->as_array();
  if (!words) members.refuse(*node, "missing: must be a list of texts like [\"--\", \"-999\"]");
  format.missing.clear();
  for (const toml::node& word : *words) {
    if (!word.is_string()) members.refuse(word, "missing: must be a list of texts like [\"--\", \"-999\"]");
    format.missing.push_back(*word.value<std::string>());
  }
}

/// How a table is written. Members that are not given stay as they are in `format`.
void readFormat(Members& members, const toml::table& table, TableFormat& format) {
  readCharacter(members, table, "separator", ",;|\t ", format.separator);
  readCharacter(members, table, "decimal", ".,", format.decimal);
  if (format.separator == format.decimal) members.refuse(table, "separator and decimal must differ");
  format.has_header = members.get<bool>("header", "true or false").value_or(format.has_header);
  format.skip_before_header = countMember(members, table, "skip_before_header", format.skip_before_header);
  format.skip_after_header = countMember(members, table, "skip_after_header", format.skip_after_header);
  format.comment = members.get<std::string>("comment", "a text").value_or(format.comment);
  format.encoding = members.get<std::string>("encoding", "a name that iconv knows").value_or(format.encoding);
  format.variable = members.get<std::string>("variable", "an array of a MATLAB file").value_or(format.variable);
  readMissing(members, table, format);
}

/// The section [table], and [tables."file"] for other tables. Returns the clocks of these.
std::map<std::string, TableClock> readTables(const toml::table& document, ImportMapping& mapping) {
  if (const toml::table* table = document["table"].as_table()) {
    Members members(*table, mapping.file, "table");
    readFormat(members, *table, mapping.format);
    members.requireAllKnown();
  }
  std::map<std::string, TableClock> clocks;
  const toml::table* tables = document["tables"].as_table();
  if (!tables) return clocks;
  for (const auto& [key, node] : *tables) {
    const std::string name(key.str());
    if (!node.is_table())
      throw BadFile(mapping.file, static_cast<int>(node.source().begin.line), static_cast<int>(node.source().begin.column),
                    fmt::format("tables.{}: must be a table, [tables.\"{}\"]", name, name));
    const toml::table& table = *node.as_table();
    Members members(table, mapping.file, fmt::format("tables.\"{}\"", name));
    TableFormat& format = mapping.formats[name] = mapping.format;
    readFormat(members, table, format);
    if (const auto clock = clockMember(&members, table, mapping.file)) clocks[name] = *clock;
    members.requireAllKnown();
  }
  return clocks;
}

void readColumns(const toml::table& columns, const std::map<std::string, TableClock>& clocks, ImportMapping& mapping) {
  mapping.clock = clockMember(nullptr, columns, mapping.file);
  for (const auto& [key, node] : columns) {
    const std::string name(key.str());
    if (const ReadingUnit* unit = unitAtEnd(name); unit && unit->quantity == "time") continue;
    ImportColumn column = readColumn(name, node, mapping.file);
    if (!column.table.empty() && !column.clock) {
      const auto clock = clocks.find(column.table);
      column.clock = clock != clocks.end() ? clock->second : plainClock();
    }
    mapping.columns.push_back(column);
  }
}

void readRows(const toml::table& table, ImportMapping& mapping) {
  Members rows(table, mapping.file, "rows");
  mapping.settle_s = rows.positive("settle_s");
  mapping.step_s = rows.positive("step_s");
  mapping.before_s = rows.positive("before_s");
  mapping.from_s = rows.get<double>("from_s", "a number");
  mapping.until_s = rows.get<double>("until_s", "a number");
  mapping.longest_gap_s = rows.positive("longest_gap_s");
  mapping.has_rows = true;
  mapping.every = static_cast<int>(rows.get<std::int64_t>("every", "a whole number").value_or(1));
  rows.know("before");
  rows.requireAllKnown();
  if (mapping.every < 1) rows.refuse(*table.get("every"), "rows.every: must be at least 1");
  if (const toml::node* before = table.get("before"); before && !before->is_table())
    rows.refuse(*before, "rows.before: must be a table like { command_0 = 0 }");
  if (const toml::table* before = table["before"].as_table())
    for (const auto& [key, node] : *before) {
      const auto value = node.value<double>();
      if (!value) rows.refuse(node, fmt::format("rows.before.{}: must be a number", key.str()));
      mapping.before[std::string(key.str())] = *value;
    }
}

bool isOwnSection(const std::string& name) {
  return std::ranges::find(own_sections, name) != own_sections.end();
}

/// One member of the sidecar as JSON in one line.
std::string jsonMember(const std::string& name, const toml::node& value) {
  std::ostringstream text;
  text << toml::json_formatter(value);
  return nlohmann::json(name).dump() + ":" + nlohmann::json::parse(text.str()).dump() + ",";
}

/// All members except the mapping's own belong to the sidecar. Each stands there in the line and column that it has in the mapping, so that
/// messages about the sidecar name the right place.
std::string sidecarJson(const toml::table& table) {
  std::vector<std::pair<toml::source_position, std::string>> members;
  for (const auto& [key, value] : table) {
    const std::string name(key.str());
    if (!isOwnSection(name) && name != "format") members.emplace_back(key.source().begin, jsonMember(name, value));
  }
  std::ranges::sort(members, [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string text = "{";
  std::size_t line = 1, column = 2;
  for (const auto& [place, member] : members) {
    for (; line < place.line; ++line, column = 1) text += '\n';
    for (; column < place.column; ++column) text += ' ';
    text += member;
    column += member.size();
  }
  return text + fmt::format("\"format\":\"{}\"}}", recording_format);
}

void addPlaces(const toml::table& table, const std::string& prefix, std::map<std::string, ImportMapping::Place>& places) {
  for (const auto& [key, value] : table) {
    const std::string name = prefix + std::string(key.str());
    const auto& begin = key.source().begin;
    places[name] = {static_cast<int>(begin.line), static_cast<int>(begin.column)};
    if (const toml::table* inner = value.as_table()) addPlaces(*inner, name + ".", places);
  }
}

/// Refuses sections that nearly have the name of one of a mapping's own: as parts of the sidecar they would change nothing.
void requireSections(const toml::table& table, const ImportMapping& mapping) {
  const std::vector<std::string> own(own_sections.begin(), own_sections.end());
  for (const auto& [key, value] : table) {
    const std::string name(key.str());
    const bool is_own = isOwnSection(name);
    if (is_own && !value.is_table()) mapping.refuse(name, fmt::format("must be a table, [{}]", name));
    if (is_own || !value.is_table() || isSidecarMember(name)) continue;
    if (const std::string nearest = nearestName(name, own); !nearest.empty())
      mapping.refuse(name, fmt::format("a mapping has no such section; did you mean [{}]?", nearest));
  }
  if (!table.contains("columns"))
    throw BadFile(mapping.file,
                  "has no section [columns], which must say which column of the table each column of the recording comes from");
}

}  // namespace

ImportColumn importColumn(const std::string& written, const ColumnName& from) {
  ImportColumn column;
  column.name = column.written = written;
  column.from = from;
  column.minimum = -infinity;
  column.maximum = infinity;
  column.linear = !written.starts_with("command_");
  const ReadingUnit* unit = unitAtEnd(written);
  if (!unit || unit->in_recordings) return column;
  column.name = written.substr(0, written.size() - unit->name.size()) + std::string(unit->base);
  column.unit_factor = unit->factor;
  return column;
}

void ImportMapping::refuse(const std::string& member, const std::string& what) const {
  const auto found = places.find(member);
  const Place place = found == places.end() ? Place{} : found->second;
  throw BadFile(file, place.line, place.column, member + ": " + what);
}

double ImportColumn::readingOf(double x) const {
  if (from.empty()) return value;
  return std::isnan(x) ? x : std::clamp(factor * x + offset, minimum, maximum);
}

ImportMapping readImportMapping(const std::string& toml_file) {
  const toml::table table = readToml(toml_file);
  ImportMapping mapping;
  mapping.file = toml_file;
  addPlaces(table, "", mapping.places);
  requireSections(table, mapping);
  readColumns(*table["columns"].as_table(), readTables(table, mapping), mapping);
  if (const toml::table* rows = table["rows"].as_table()) readRows(*rows, mapping);
  mapping.sidecar_json = sidecarJson(table);
  return mapping;
}

}  // namespace musclesim
