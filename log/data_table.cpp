#include "data_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "encoding.h"
#include "matlab.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/parameters.h"
#include "musclesim/base/text.h"

namespace musclesim {

namespace {

/// A name for a message: as it is, if a terminal can show it.
std::string shown(const std::string& name) {
  return isUtf8(name) ? name : inQuotes(name);
}

}  // namespace

std::string withoutPlace(const BadFile& error) {
  const std::string message = error.what();
  const auto colon = message.find(": ", error.file().size());
  return colon == std::string::npos ? message : message.substr(colon + 2);
}

DataTable::DataTable(const std::string& file, const TableFormat& format) : file_(file) {
  TableFormat written = format;
  if (isMatlabFile(file)) {
    written = TableFormat();
    written.missing = format.missing;
  }
  read(isMatlabFile(file) ? matlabTable(file, format.variable, notes_) : readTextFile(file, CsvLimits().file_bytes), written);
}

DataTable::DataTable(std::string bytes, const std::string& file, const TableFormat& format) : file_(file) {
  read(std::move(bytes), format);
}

void DataTable::read(std::string bytes, const TableFormat& format) {
  text_ = toUtf8(std::move(bytes), format.encoding, file_);
  if (text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
  dropTornLine();
  reader_.emplace(text_, file_, CsvLimits(), format);
  for (const CsvCell& cell : reader_->header()) {
    names_.emplace_back(cell.text);
    header_columns_.push_back(cell.column);
  }
  readRows();
}

/// A logger that lost its power ends within a number.
void DataTable::dropTornLine() {
  const auto last_end = text_.rfind('\n');
  if (text_.empty() || text_.ends_with('\n') || last_end == std::string::npos) return;
  notes_.push_back(fmt::format("{}: the last line has no line end and may be cut; it is left out: {}", file_,
                               inQuotes(std::string_view(text_).substr(last_end + 1))));
  text_.erase(last_end + 1);
}

void DataTable::readRows() {
  std::vector<CsvCell> cells;
  std::size_t short_count = 0;
  int short_line = 0;
  while (reader_->readRow(cells)) {
    for (std::size_t i = names_.size(); i < cells.size(); ++i) {
      names_.push_back(fmt::format("{}", i + 1));
      header_columns_.push_back(1);
    }
    for (const CsvCell& cell : cells)
      cells_.push_back({static_cast<std::uint32_t>(cell.text.data() - text_.data()), static_cast<std::uint32_t>(cell.text.size())});
    lines_.push_back(reader_->line());
    if (reader_->rowIsShort() && short_count++ == 0) short_line = reader_->line();
  }
  if (short_count > 0 && short_count < lines_.size())
    notes_.push_back(
        fmt::format("{}: {} of {} rows have fewer cells than the table has columns, the first in line {}; what they lack counts "
                    "as not measured",
                    file_, short_count, lines_.size(), short_line));
}

std::size_t DataTable::indexOf(const ColumnName& column) const {
  if (column.number > 0) {
    if (static_cast<std::size_t>(column.number) <= names_.size()) return static_cast<std::size_t>(column.number) - 1;
    throw BadFile(file_, headerLine(), 0, fmt::format("there is no column {}: the table has {} columns", column.number, names_.size()));
  }
  const auto found = std::ranges::find(names_, column.name);
  if (found == names_.end()) refuseName(column.name);
  const auto again = std::find(found + 1, names_.end(), column.name);
  const auto index = static_cast<std::size_t>(found - names_.begin());
  if (again != names_.end())
    refuseHeader(
        static_cast<std::size_t>(again - names_.begin()),
        fmt::format(
            "several columns are named \"{}\": {} and {}; choose one by its number: from = {} in a mapping, #{} with --columns or --where",
            shown(column.name), index + 1, again - names_.begin() + 1, index + 1, index + 1));
  return index;
}

void DataTable::refuseName(const std::string& name) const {
  std::vector<std::string> known;
  for (const std::string& column : names_) known.push_back(shown(column));
  const bool is_utf8 = known == names_;
  const std::string nearest = is_utf8 ? nearestName(name, names_) : "";
  throw BadFile(file_, headerLine(), 0,
                fmt::format("there is no column \"{}\"{}; the columns are {}{}", shown(name),
                            nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest), fmt::join(known, ", "),
                            is_utf8 ? "; musclesim import --look shows how a table is written"
                                    : " (not UTF-8: the mapping's [table] may name the encoding, or a column its number)"));
}

std::string DataTable::shownName(std::size_t column) const {
  return shown(names_[column]);
}

std::string_view DataTable::text(std::size_t row, std::size_t column) const {
  const Cell& cell = cells_[row * names_.size() + column];
  return std::string_view(text_).substr(cell.begin, cell.length);
}

CsvCell DataTable::cellAt(std::size_t row, std::size_t column) const {
  const std::size_t begin = cells_[row * names_.size() + column].begin;
  const auto line_end = begin > 0 ? text_.rfind('\n', begin - 1) : std::string::npos;
  const std::size_t line_begin = line_end == std::string::npos ? 0 : line_end + 1;
  return {text(row, column), lines_[row], static_cast<int>(begin - line_begin) + 1};
}

double DataTable::number(std::size_t row, std::size_t column) const {
  return reader_->number(cellAt(row, column), shown(names_[column]));
}

std::vector<double> DataTable::numbers(std::size_t column) const {
  std::vector<double> values(rowCount());
  for (std::size_t row = 0; row < values.size(); ++row) values[row] = number(row, column);
  return values;
}

void DataTable::refuse(std::size_t row, std::size_t column, const std::string& what) const {
  reader_->refuse(cellAt(row, column), what);
}

void DataTable::refuseHeader(std::size_t column, const std::string& what) const {
  throw BadFile(file_, headerLine(), headerLine() > 0 ? header_columns_[column] : 0, what);
}

}  // namespace musclesim
