#include "musclesim/log/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "musclesim/base/error.h"
#include "musclesim/base/text.h"

namespace musclesim {

namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return text.substr(0, 0);
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

bool isBlank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

bool isNan(std::string_view text) {
  return text.size() == 3 && (text[0] | 0x20) == 'n' && (text[1] | 0x20) == 'a' && (text[2] | 0x20) == 'n';
}

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string file, const CsvLimits& limits)
    : file_(std::move(file)), limits_(limits), rest_(text) {
  if (text.size() > limits_.file_bytes)
    throw BadFile(file_, fmt::format("is larger than the {} MiB that are allowed", limits_.file_bytes >> 20));
  if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
  requirePlainText();
  readHeader();
}

void CsvReader::refuseAt(int line, std::size_t offset, const std::string& what) const {
  throw BadFile(file_, line, static_cast<int>(offset) + 1, what);
}

void CsvReader::refuse(const CsvCell& cell, const std::string& what) const {
  throw BadFile(file_, cell.line, cell.column, what);
}

void CsvReader::requirePlainText() const {
  const auto nul = rest_.find('\0');
  if (nul == std::string_view::npos) return;
  const auto place = placeInText(rest_, nul);
  throw BadFile(file_, place.line, place.column, "NUL byte: this is not a text file in UTF-8 (binary, or UTF-16?)");
}

bool CsvReader::nextLine(std::string_view& line) {
  if (rest_.empty()) return false;
  ++line_;
  const auto end = rest_.substr(0, limits_.line_bytes + 1).find('\n');
  if (end == std::string_view::npos && rest_.size() > limits_.line_bytes)
    refuseAt(line_, limits_.line_bytes, fmt::format("the line is longer than the {} bytes that are allowed", limits_.line_bytes));
  line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return true;
}

void CsvReader::readHeader() {
  std::string_view line;
  do {
    if (!nextLine(line)) throw BadFile(file_, "has no header row: the first line that is not a comment (#) must name the columns");
    if (isBlank(line)) refuseAt(line_, 0, "empty line before the header: only comments that begin with # may stand there");
  } while (line.starts_with('#'));
  header_line_ = line_;
  split(line, header_);
  if (header_.size() == 1 && line.find_first_of(";\t") != std::string_view::npos)
    refuseAt(line_, line.find_first_of(";\t"), "cells must be separated by commas, not by semicolons or tabs");
}

void CsvReader::split(std::string_view line, std::vector<CsvCell>& cells) const {
  if (const auto quote = line.find('"'); quote != std::string_view::npos)
    refuseAt(line_, quote, "quoted cells are not supported: names and numbers must be written without quotes");
  if (const auto carriage_return = line.find('\r'); carriage_return != std::string_view::npos)
    refuseAt(line_, carriage_return, "carriage return inside a line: lines must end in \\n or \\r\\n");
  cells.clear();
  std::size_t begin = 0;
  while (true) {
    const auto comma = std::min(line.find(',', begin), line.size());
    const std::string_view text = trimmed(line.substr(begin, comma - begin));
    const std::size_t offset = text.empty() ? begin : static_cast<std::size_t>(text.data() - line.data());
    cells.push_back({text, line_, static_cast<int>(offset) + 1});
    if (cells.size() > limits_.column_count)
      refuse(cells.back(), fmt::format("more than the {} columns that are allowed", limits_.column_count));
    if (comma == line.size()) return;
    begin = comma + 1;
  }
}

bool CsvReader::readRow(std::vector<CsvCell>& cells) {
  std::string_view line;
  if (!nextLine(line)) return false;
  if (isBlank(line)) {
    if (!isBlank(rest_)) refuseAt(line_, 0, "empty line between rows");
    rest_ = {};
    return false;
  }
  if (line.starts_with('#')) refuseAt(line_, 0, "a comment (#) may stand only before the header row");
  if (++row_count_ > limits_.row_count) refuseAt(line_, 0, fmt::format("more than the {} rows that are allowed", limits_.row_count));
  if (row_count_ * header_.size() > limits_.cell_count)
    refuseAt(line_, 0, fmt::format("more than the {} cells (rows times columns) that are allowed", limits_.cell_count));
  split(line, cells);
  if (cells.size() != header_.size())
    refuse(cells[std::min(cells.size(), header_.size() + 1) - 1],
           fmt::format("the row has {} cells but the header in line {} names {} columns", cells.size(), header_line_, header_.size()));
  return true;
}

double CsvReader::number(const CsvCell& cell, std::string_view column_name) const {
  std::string_view text = cell.text;
  if (text.empty() || isNan(text)) return std::numeric_limits<double>::quiet_NaN();
  if (text.starts_with('+') && text.size() > 1 && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = result.ptr == text.data() + text.size() && result.ec != std::errc::invalid_argument && !std::isnan(value);
  if (is_number && result.ec == std::errc() && std::isfinite(value)) return value;
  const std::string where = fmt::format("column {}: {} ", column_name, inQuotes(cell.text));
  if (!is_number) refuse(cell, where + "is not a number (allowed: a number with a decimal point, an empty cell, or nan)");
  if (result.ec == std::errc::result_out_of_range) refuse(cell, where + "is too large or too small for a double");
  refuse(cell, where + "is infinite (allowed: finite numbers, an empty cell, or nan)");
}

}  // namespace musclesim
