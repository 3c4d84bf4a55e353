#include "targets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../log/columns.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/log/csv.h"

namespace musclesim {

namespace {

bool isTarget(const Column& column) {
  return column.quantity == "target" || column.quantity == "angle" || column.quantity == "hand";
}

}  // namespace

TargetTable::TargetTable(const std::string& csv_file) : file_(csv_file) {
  const std::string text = readTextFile(csv_file, CsvLimits().file_bytes);
  CsvReader csv(text, csv_file);
  std::vector<Column> columns;
  for (const CsvCell& cell : csv.header()) {
    try {
      columns.push_back(parseColumnName(std::string(cell.text)));
    } catch (const BadParameter& error) {
      csv.refuse(cell, error.what());
    }
    if (isTarget(columns.back())) columns_.push_back({columns.back().name, {}});
  }
  std::vector<CsvCell> cells;
  while (csv.readRow(cells)) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].quantity != "time" && !isTarget(columns[i])) continue;
      const double value = csv.number(cells[i], columns[i].name) * columns[i].factor;
      if (std::isnan(value)) csv.refuse(cells[i], columns[i].name + " is not given: every row needs its targets");
      if (columns[i].quantity == "time" && !time_s_.empty() && value <= time_s_.back())
        csv.refuse(cells[i], fmt::format("time_s = {} s: must be later than the row before", value));
      (columns[i].quantity == "time" ? time_s_ : columns_[next++].second).push_back(value);
    }
  }
  if (time_s_.empty()) throw BadFile(csv_file, "needs the column time_s and at least one row");
}

std::vector<double> TargetTable::column(const std::string& joint) const {
  const std::vector<std::string> names = joint.empty() ? std::vector<std::string>{"target_y_mm", "hand_y_mm"}
                                                       : std::vector<std::string>{"target_" + joint + "_deg", "angle_" + joint + "_deg"};
  for (const std::string& name : names)
    for (const auto& [known, values] : columns_)
      if (known == name) return values;
  throw BadFile(file_, fmt::format("has no column {} or {}", names[0], names[1]));
}

double TargetTable::at(const std::vector<double>& column, double time_s) const {
  const auto later = std::upper_bound(time_s_.begin(), time_s_.end(), time_s);
  if (later == time_s_.begin()) return column.front();
  if (later == time_s_.end()) return column.back();
  const auto b = static_cast<std::size_t>(later - time_s_.begin());
  return column[b - 1] + (time_s - time_s_[b - 1]) / (time_s_[b] - time_s_[b - 1]) * (column[b] - column[b - 1]);
}

}  // namespace musclesim
