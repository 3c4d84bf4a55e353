#include "point_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/text.h"
#include "reading_units.h"

namespace musclesim {

namespace {

/// What values of a quantity a muscle can have, in kPa, mm and N, or as a fraction of full scale.
struct Plausible {
  double lowest, highest;
  std::string hint;
};

Plausible plausible(const std::string& quantity, bool has_unit) {
  if (quantity == "length") return {5, 10000, "is the unit right (length_mm, _cm, _m), or are columns swapped?"};
  if (quantity == "force") return {-1000, 1e5, "pulling positive; is the unit right?"};
  if (has_unit) return {-30, 3000, "gauge pressure; is the unit right?"};
  return {-0.05, 1.05, "a fraction of full scale; is it in kPa, bar or MPa? Then name the column pressure_kPa, _bar or _MPa"};
}

/// Names of the units of a quantity; the first is the one that is assumed, empty for a fraction.
std::vector<std::string> unitNames(const std::string& quantity) {
  std::vector<std::string> names;
  if (quantity == "pressure") names.emplace_back();
  for (const ReadingUnit& unit : readingUnits())
    if (unit.quantity == quantity) names.emplace_back(unit.name);
  return names;
}

std::string withUnit(const std::string& quantity, const std::string& unit) {
  return unit.empty() ? quantity : quantity + "_" + unit;
}

/// "pressure (fraction), pressure_kPa, ..."
std::string allowedNames(const std::string& quantity) {
  std::vector<std::string> names;
  for (const std::string& unit : unitNames(quantity)) names.push_back(unit.empty() ? quantity + " (fraction)" : withUnit(quantity, unit));
  return fmt::format("{}", fmt::join(names, ", "));
}

bool hasUnit(const std::string& quantity, const std::string& unit) {
  const auto names = unitNames(quantity);
  return std::ranges::find(names, unit) != names.end();
}

/// A column's name and unit. The unit may follow a colon or end the name; `has_unit` is false if neither is the case.
struct MappedColumn {
  std::string name, unit;
  bool has_unit;
};

MappedColumn splitUnit(const std::string& written) {
  if (const auto colon = written.rfind(':'); colon != std::string::npos) {
    const std::string unit = written.substr(colon + 1);
    return {written.substr(0, colon), unit == "fraction" ? "" : unit, true};
  }
  const auto underscore = written.rfind('_');
  const std::string ending = underscore == std::string::npos ? "" : written.substr(underscore + 1);
  const bool is_unit = !ending.empty() && std::ranges::any_of(readingUnits(), [&](const ReadingUnit& unit) {
    return unit.name == ending && unit.quantity != "time";
  });
  return {written, is_unit ? ending : "", is_unit};
}

/// "#3" is the third column, if no column has this name.
ColumnName nameOrNumber(const DataTable& table, const std::string& written) {
  int number = 0;
  const char* end = written.data() + written.size();
  const bool is_number = written.starts_with('#') && std::from_chars(written.data() + 1, end, number).ptr == end && number > 0;
  if (is_number && std::ranges::find(table.names(), written) == table.names().end()) return {"", number};
  return {written, 0};
}

/// The column with all that its written name, like pressure_psi, says.
PointColumn pointColumn(const DataTable& table, const ImportColumn& source, const std::string& quantity) {
  PointColumn column;
  column.source = source;
  if (!source.from.empty()) column.index = table.indexOf(source.from);
  const ReadingUnit* unit = unitAtEnd(source.written);
  if (unit) {
    column.unit = unit->name;
    column.factor = unit->factor;
  }
  const Plausible range = plausible(quantity, unit != nullptr);
  column.lowest = range.lowest / column.factor;
  column.highest = range.highest / column.factor;
  column.hint = range.hint;
  return column;
}

}  // namespace

double PointColumn::value(const DataTable& table, std::size_t row) const {
  const double number = source.readingOf(index ? table.number(row, *index) : 0);
  if (std::isnan(number)) return number;
  if (!(number >= lowest && number <= highest)) {
    const std::string with_unit = unit.empty() ? "" : " " + unit;
    const std::string what = fmt::format("{:g}{} must lie in {:g} .. {:g}{}: {}", number, with_unit, lowest, highest, with_unit, hint);
    if (!index) throw BadParameter(fmt::format("{}: {}", source.written, what));
    table.refuse(row, *index, fmt::format("column {}: {}", table.names()[*index], what));
  }
  return number * factor;
}

PointColumns::PointColumns(const DataTable& table, const StaticPointsOptions& options, const std::vector<ImportColumn>& mapped)
    : table_(table) {
  for (const auto& [quantity, name] : options.columns)
    if (quantity != "pressure" && quantity != "length" && quantity != "force")
      throw BadParameter("--columns", quantity + "=" + name, "map pressure, length or force to a column");
  for (const std::string quantity : {"pressure", "length", "force"}) columns_.push_back(find(quantity, options, mapped));
  for (const auto& [name, value] : options.where) filters_.emplace_back(table.indexOf(nameOrNumber(table, name)), value);
}

PointColumn PointColumns::find(const std::string& quantity, const StaticPointsOptions& options, const std::vector<ImportColumn>& mapped) {
  for (const auto& [name, written] : options.columns)
    if (name == quantity) return fromOption(quantity, written);
  for (const ImportColumn& column : mapped)
    if (column.written.substr(0, column.written.find('_')) == quantity) return pointColumn(table_, column, quantity);
  return fromNames(quantity);
}

PointColumn PointColumns::fromOption(const std::string& quantity, const std::string& written) {
  const MappedColumn column = splitUnit(written);
  const std::string unit = column.has_unit ? column.unit : unitNames(quantity).front();
  if (!hasUnit(quantity, unit))
    throw BadParameter("--columns", quantity + "=" + written,
                       fmt::format("be a column that ends like {}, or NAME:unit with such a unit", allowedNames(quantity)));
  if (!column.has_unit) assumed_.push_back(fmt::format("{} in {}", column.name, unit.empty() ? "fractions of full scale" : unit));
  return pointColumn(table_, importColumn(withUnit(quantity, unit), nameOrNumber(table_, column.name)), quantity);
}

PointColumn PointColumns::fromNames(const std::string& quantity) const {
  const std::vector<std::string>& names = table_.names();
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < names.size(); ++i)
    for (const std::string& unit : unitNames(quantity))
      if (names[i] == withUnit(quantity, unit)) found.push_back(i);
  if (found.size() == 1) return pointColumn(table_, importColumn(names[found[0]], {"", static_cast<int>(found[0]) + 1}), quantity);
  if (found.size() > 1)
    throw BadFile(table_.file(), table_.headerLine(), 0,
                  fmt::format("columns {} and {} both hold the {}; choose one with --columns {}=NAME", names[found[0]], names[found[1]],
                              quantity, quantity));
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == quantity) table_.refuseHeader(i, fmt::format("column {} has no unit; allowed: {}", quantity, allowedNames(quantity)));
  throw BadFile(
      table_.file(), table_.headerLine(), 0,
      fmt::format("no column holds the {}; allowed: {}; the file has {}; if one of these holds it, name it with --columns {}=NAME",
                  quantity, allowedNames(quantity), fmt::join(names, ", "), quantity));
}

bool PointColumns::selects(std::size_t row) const {
  return std::ranges::all_of(filters_, [&](const auto& filter) { return table_.text(row, filter.first) == filter.second; });
}

std::vector<std::string> PointColumns::ignored() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < table_.names().size(); ++i) {
    const bool is_used = std::ranges::any_of(columns_, [&](const PointColumn& column) { return column.index == i; }) ||
                         std::ranges::any_of(filters_, [&](const auto& filter) { return filter.first == i; });
    if (!is_used && !table_.names()[i].empty()) names.push_back(table_.names()[i]);
  }
  return names;
}

}  // namespace musclesim
