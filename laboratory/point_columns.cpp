#include "point_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/parameters.h"
#include "musclesim/base/text.h"
#include "musclesim/base/units.h"

namespace musclesim {

namespace {

/// A unit that a quantity can have in a file, and the plausible range of its values for a muscle.
struct Unit {
  std::string quantity, unit;
  double factor, lowest, highest;  ///< range in the unit itself
  std::string hint;
};

const std::vector<Unit>& units() {
  const std::string not_fraction = "a fraction of full scale; is it in kPa, bar or MPa? Then name the column pressure_kPa, _bar or _MPa";
  const std::string pressure = "gauge pressure; is the unit right?", force = "pulling positive; is the unit right?";
  const std::string length = "is the unit right (length_mm, _cm, _m), or are columns swapped?";
  static const std::vector<Unit> all = {{"pressure", "", 1, -0.05, 1.05, not_fraction},
                                        {"pressure", "kPa", 1, -30, 3000, pressure},
                                        {"pressure", "bar", kPa_per_bar, -0.3, 30, pressure},
                                        {"pressure", "MPa", kPa_per_MPa, -0.03, 3, pressure},
                                        {"length", "mm", 1, 5, 10000, length},
                                        {"length", "cm", mm_per_cm, 0.5, 1000, length},
                                        {"length", "m", mm_per_m, 0.005, 10, length},
                                        {"force", "N", 1, -1000, 1e5, force}};
  return all;
}

std::string withUnit(const std::string& quantity, const std::string& unit) {
  return unit.empty() ? quantity : quantity + "_" + unit;
}

/// "pressure (fraction), pressure_kPa, ..."
std::string allowedNames(const std::string& quantity) {
  std::vector<std::string> names;
  for (const auto& unit : units())
    if (unit.quantity == quantity) names.push_back(unit.unit.empty() ? quantity + " (fraction)" : withUnit(quantity, unit.unit));
  return fmt::format("{}", fmt::join(names, ", "));
}

const Unit* unitOf(const std::string& quantity, const std::string& unit) {
  for (const auto& known : units())
    if (known.quantity == quantity && known.unit == unit) return &known;
  return nullptr;
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
  const bool is_unit =
      std::any_of(units().begin(), units().end(), [&](const Unit& unit) { return !ending.empty() && unit.unit == ending; });
  return {written, is_unit ? ending : "", is_unit};
}

/// The unit assumed for a name without a unit: fraction, mm, N.
const Unit& plainUnit(const std::string& quantity) {
  return *std::find_if(units().begin(), units().end(), [&](const Unit& unit) { return unit.quantity == quantity; });
}

}  // namespace

double PointColumn::value(const CsvReader& reader, const std::vector<CsvCell>& cells) const {
  const double number = reader.number(cells[index], name);
  if (std::isnan(number)) return number;
  if (!(number >= lowest && number <= highest))
    reader.refuse(cells[index], fmt::format("column {}: {:g}{} must lie in {:g} .. {:g}{}: {}", name, number,
                                            unit.empty() ? "" : " " + unit, lowest, highest, unit.empty() ? "" : " " + unit, hint));
  return number * factor;
}

PointColumns::PointColumns(const CsvReader& reader, const std::string& file, const StaticPointsOptions& options)
    : reader_(reader), file_(file) {
  for (const auto& [quantity, name] : options.columns)
    if (quantity != "pressure" && quantity != "length" && quantity != "force")
      throw BadParameter("--columns", quantity + "=" + name, "map pressure, length or force to a column");
  for (const std::string quantity : {"pressure", "length", "force"}) columns_.push_back(find(quantity, options));
  for (const auto& [name, value] : options.where) filters_.emplace_back(indexOf(name), value);
  for (std::size_t i = 0; i < reader.header().size(); ++i) {
    const bool is_used = std::any_of(columns_.begin(), columns_.end(), [&](const auto& column) { return column.index == i; }) ||
                         std::any_of(filters_.begin(), filters_.end(), [&](const auto& filter) { return filter.first == i; });
    if (!is_used) ignored_.emplace_back(reader.header()[i].text);
  }
}

std::size_t PointColumns::indexOf(const std::string& name) const {
  std::vector<std::string> names;
  for (const auto& cell : reader_.header()) names.emplace_back(cell.text);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw BadFile(file_, reader_.headerLine(), 0,
                fmt::format("there is no column {}; the columns are {}", inQuotes(name), fmt::join(names, ", ")));
}

PointColumn PointColumns::find(const std::string& quantity, const StaticPointsOptions& options) {
  const auto columnOf = [&](std::size_t index, const Unit& unit) {
    return PointColumn{index, std::string(reader_.header()[index].text), unit.factor, unit.lowest, unit.highest, unit.unit, unit.hint};
  };
  for (const auto& [mapped, written] : options.columns) {
    if (mapped != quantity) continue;
    const MappedColumn column = splitUnit(written);
    const Unit* unit = column.has_unit ? unitOf(quantity, column.unit) : &plainUnit(quantity);
    if (!unit)
      throw BadParameter("--columns", quantity + "=" + written,
                         fmt::format("be a column that ends like {}, or NAME:unit with such a unit", allowedNames(quantity)));
    if (!column.has_unit)
      assumed_.push_back(fmt::format("{} in {}", column.name, unit->unit.empty() ? "fractions of full scale" : unit->unit));
    return columnOf(indexOf(column.name), *unit);
  }
  std::vector<PointColumn> found;
  for (std::size_t i = 0; i < reader_.header().size(); ++i)
    for (const auto& unit : units())
      if (unit.quantity == quantity && reader_.header()[i].text == withUnit(quantity, unit.unit)) found.push_back(columnOf(i, unit));
  if (found.size() == 1) return found[0];
  if (found.size() > 1)
    throw BadFile(file_, reader_.headerLine(), 0,
                  fmt::format("columns {} and {} both hold the {}; choose one with --columns {}=NAME", found[0].name, found[1].name,
                              quantity, quantity));
  for (const auto& cell : reader_.header())
    if (cell.text == quantity) reader_.refuse(cell, fmt::format("column {} has no unit; allowed: {}", quantity, allowedNames(quantity)));
  std::vector<std::string> names;
  for (const auto& cell : reader_.header()) names.emplace_back(cell.text);
  throw BadFile(
      file_, reader_.headerLine(), 0,
      fmt::format("no column holds the {}; allowed: {}; the file has {}; if one of these holds it, name it with --columns {}=NAME",
                  quantity, allowedNames(quantity), fmt::join(names, ", "), quantity));
}

bool PointColumns::selects(const std::vector<CsvCell>& cells) const {
  return std::all_of(filters_.begin(), filters_.end(), [&](const auto& filter) { return cells[filter.first].text == filter.second; });
}

}  // namespace musclesim
