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

/// What C and C++ programs of Windows print for "not a number".
bool isWindowsNan(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  return text.starts_with("1.#QNAN") || text.starts_with("1.#IND") || text.starts_with("1.#SNAN");
}

}  // namespace

TableFormat TableFormat::recording() {
  TableFormat format;
  format.is_foreign = false;
  return format;
}

bool readNumber(std::string_view text, char decimal, double& value, bool& is_out_of_range) {
  if (text.starts_with('+') && text.size() > 1 && text[1] != '-') text.remove_prefix(1);
  std::string with_point;
  if (decimal != '.') {
    if (text.find('.') != std::string_view::npos) return false;
    with_point = text;
    std::replace(with_point.begin(), with_point.end(), decimal, '.');
    text = with_point;
  }
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  is_out_of_range = result.ec == std::errc::result_out_of_range;
  return !text.empty() && result.ptr == text.data() + text.size() && result.ec != std::errc::invalid_argument;
}

CsvReader::CsvReader(std::string_view text, std::string file, const CsvLimits& limits, const TableFormat& format)
    : file_(std::move(file)), format_(format), limits_(limits), rest_(text) {
  if (text.size() > limits_.file_bytes)
    throw BadFile(file_, fmt::format("is larger than the {} MiB that are allowed", limits_.file_bytes >> 20));
  if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
  for (const std::string& word : format_.missing) {
    double value = 0;
    bool is_out_of_range = false;
    if (readNumber(word, format_.decimal, value, is_out_of_range)) missing_numbers_.push_back(value);
  }
  requirePlainText();
  readHeader();
}

void CsvReader::refuseAt(int line, std::size_t offset, const std::string& what) const {
  throw BadFile(file_, line, static_cast<int>(offset) + 1, what);
}

void CsvReader::refuseShape(const CsvCell& place, const std::string& what) const {
  refuse(place, what + (format_.is_foreign ? "; musclesim import --look shows how a table is written" : ""));
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

bool CsvReader::isComment(std::string_view line) const {
  return !format_.comment.empty() && line.starts_with(format_.comment);
}

bool CsvReader::nextContent(std::string_view& line) {
  while (nextLine(line))
    if (!isComment(line) && !(format_.is_foreign && isBlank(line))) return true;
  return false;
}

void CsvReader::skipLines(int count) {
  std::string_view line;
  for (int i = 0; i < count; ++i)
    if (!nextLine(line)) throw BadFile(file_, fmt::format("has only {} lines, but the mapping skips more", line_));
}

void CsvReader::readHeader() {
  skipLines(format_.skip_before_header);
  if (format_.has_header) {
    std::string_view line;
    if (!nextContent(line)) throw BadFile(file_, "has no header row: the first line that is not a comment (#) must name the columns");
    if (isBlank(line)) refuseAt(line_, 0, "empty line before the header: only comments that begin with # may stand there");
    header_line_ = line_;
    split(line, header_);
    requireSeparators(line);
    if (format_.is_foreign) requireNames();
    width_ = header_.size();
  }
  skipLines(format_.skip_after_header);
}

void CsvReader::requireSeparators(std::string_view line) const {
  const auto other = line.find_first_of(";\t");
  if (header_.size() > 1 || other == std::string_view::npos) return;
  const std::string hint =
      format_.is_foreign ? fmt::format("; the mapping's [table] needs separator = \"{}\"", line[other] == ';' ? ";" : "\\t") : "";
  refuseShape({line, line_, static_cast<int>(other) + 1},
              fmt::format("cells must be separated by {}, not by semicolons or tabs{}",
                          format_.separator == ',' ? "commas" : "what the mapping's [table] names as separator", hint));
}

/// Refuses a first row of numbers. Empty names at the end come from separators at the end of lines.
void CsvReader::requireNames() const {
  const bool all_numbers = std::all_of(header_.begin(), header_.end(), [&](const CsvCell& cell) {
    double value = 0;
    bool is_out_of_range = false;
    return cell.text.empty() || readNumber(cell.text, format_.decimal, value, is_out_of_range);
  });
  if (all_numbers)
    refuseShape(header_.front(),
                "the first row holds numbers: a table without a header? Then the mapping must say header = false in [table]");
}

/// The offset behind the quote that ends a quoted cell; a quote within it is written twice.
std::size_t CsvReader::endOfQuotes(std::string_view line, std::size_t begin) const {
  for (std::size_t end = line.find('"', begin + 1); end != std::string_view::npos; end = line.find('"', end + 2))
    if (end + 1 == line.size() || line[end + 1] != '"') return end + 1;
  refuseShape({line, line_, static_cast<int>(begin) + 1}, "the quote is not closed in this line");
}

void CsvReader::addCell(std::string_view line, std::size_t begin, std::size_t end, std::vector<CsvCell>& cells) const {
  std::string_view text = trimmed(line.substr(begin, end - begin));
  const bool is_quoted = format_.is_foreign && text.size() >= 2 && text.front() == '"' && text.back() == '"';
  if (is_quoted) text = trimmed(text.substr(1, text.size() - 2));
  const std::size_t offset = text.empty() ? begin : static_cast<std::size_t>(text.data() - line.data());
  cells.push_back({text, line_, static_cast<int>(offset) + 1});
  if (cells.size() > limits_.column_count)
    refuse(cells.back(), fmt::format("more than the {} columns that are allowed", limits_.column_count));
}

void CsvReader::split(std::string_view line, std::vector<CsvCell>& cells) const {
  if (const auto quote = line.find('"'); quote != std::string_view::npos && !format_.is_foreign)
    refuseAt(line_, quote, "quoted cells are not supported: names and numbers must be written without quotes");
  if (const auto carriage_return = line.find('\r'); carriage_return != std::string_view::npos)
    refuseAt(line_, carriage_return, "carriage return inside a line: lines must end in \\n or \\r\\n");
  const bool by_blanks = format_.separator == ' ';
  const std::string_view blanks = format_.separator == '\t' ? " " : " \t";
  cells.clear();
  std::size_t begin = 0;
  while (true) {
    if (format_.is_foreign) begin = std::min(line.find_first_not_of(blanks, begin), line.size());
    if (by_blanks && begin == line.size() && !cells.empty()) return;
    const std::size_t from = format_.is_foreign && begin < line.size() && line[begin] == '"' ? endOfQuotes(line, begin) : begin;
    const std::size_t end = std::min(by_blanks ? line.find_first_of(blanks, from) : line.find(format_.separator, from), line.size());
    addCell(line, begin, end, cells);
    if (end == line.size()) return;
    begin = end + 1;
  }
}

/// Makes the row of a foreign table as wide as the table: empty cells at its end come and go.
void CsvReader::fitWidth(std::vector<CsvCell>& cells) {
  if (width_ == 0) width_ = cells.size();
  if (!format_.is_foreign) return;
  row_is_short_ = cells.size() < width_;
  while (cells.size() > width_ && cells.back().text.empty()) cells.pop_back();
  while (cells.size() < width_) cells.push_back({cells.back().text.substr(cells.back().text.size()), line_, cells.back().column});
}

bool CsvReader::readRow(std::vector<CsvCell>& cells) {
  std::string_view line;
  if (!(format_.is_foreign ? nextContent(line) : nextLine(line))) return false;
  if (isBlank(line)) {
    if (!isBlank(rest_)) refuseAt(line_, 0, "empty line between rows");
    rest_ = {};
    return false;
  }
  if (isComment(line)) refuseAt(line_, 0, "a comment (#) may stand only before the header row");
  if (++row_count_ > limits_.row_count) refuseAt(line_, 0, fmt::format("more than the {} rows that are allowed", limits_.row_count));
  split(line, cells);
  fitWidth(cells);
  if (row_count_ * width_ > limits_.cell_count)
    refuseAt(line_, 0, fmt::format("more than the {} cells (rows times columns) that are allowed", limits_.cell_count));
  if (cells.size() != width_) {
    const std::string than = format_.has_header ? fmt::format("the header in line {} names {} columns", header_line_, width_)
                                                : fmt::format("the first row has {}", width_);
    const bool may_be_decimals = format_.is_foreign && format_.separator == ',' && cells.size() == 2 * width_;
    refuseShape(cells[std::min(cells.size(), width_ + 1) - 1],
                fmt::format("the row has {} cells but {}{}", cells.size(), than,
                            may_be_decimals ? "; if its numbers have decimal commas, save it with semicolons between the cells" : ""));
  }
  return true;
}

bool CsvReader::isMissing(std::string_view text) const {
  return text.empty() || isNan(text) ||
         (format_.is_foreign &&
          (isWindowsNan(text) || std::find(format_.missing.begin(), format_.missing.end(), text) != format_.missing.end()));
}

/// What a mapping may say to make a cell of a foreign table a number.
std::string CsvReader::helpFor(const CsvCell& cell) const {
  double value = 0;
  bool is_out_of_range = false;
  const char other = format_.decimal == '.' ? ',' : '.';
  if (!format_.is_foreign) return "";
  if (readNumber(cell.text, other, value, is_out_of_range))
    return fmt::format("; is this a decimal {}? Then the mapping's [table] needs decimal = \"{}\"", other == ',' ? "comma" : "point",
                       other);
  const bool is_below_header = format_.has_header && cell.line == header_line_ + 1;
  return is_below_header ? "; if this is a row of units, the mapping's [table] needs skip_after_header = 1" : "";
}

double CsvReader::number(const CsvCell& cell, std::string_view column_name) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (isMissing(cell.text)) return nan;
  double value = 0;
  bool is_out_of_range = false;
  const bool is_number = readNumber(cell.text, format_.decimal, value, is_out_of_range);
  if (is_number && !is_out_of_range && std::isfinite(value))
    return std::find(missing_numbers_.begin(), missing_numbers_.end(), value) == missing_numbers_.end() ? value : nan;
  if (is_number && format_.is_foreign && std::isnan(value)) return nan;
  const std::string where = fmt::format("column {}: {} ", column_name, inQuotes(cell.text));
  const auto allowed = [&](const std::string& number) {
    return fmt::format(" (allowed: {}, an empty cell, or nan{})", number,
                       format_.is_foreign ? "; other marks for no reading must stand in missing of the mapping's [table]" : "");
  };
  if (!is_number || std::isnan(value))
    refuse(cell, where + "is not a number" +
                     allowed(format_.decimal == '.' ? "a number with a decimal point" : "a number with a decimal comma") + helpFor(cell));
  if (is_out_of_range) refuse(cell, where + "is too large or too small for a double");
  refuse(cell, where + "is infinite" + allowed("finite numbers"));
}

}  // namespace musclesim
