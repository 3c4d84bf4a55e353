#include "table_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "data_table.h"
#include "encoding.h"
#include "import_clock.h"
#include "matlab.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"

namespace musclesim {

namespace {

constexpr std::size_t sampled_lines = 400;

/// Units that a name or a row of units may hold, and how mappings write them.
const std::map<std::string, std::string>& unitWords() {
  static const std::map<std::string, std::string> words = {
      {"s", "s"},   {"sec", "s"},       {"seconds", "s"}, {"second", "s"},  {"ms", "ms"},   {"us", "us"},
      {"µs", "us"}, {"ns", "ns"},       {"min", "min"},   {"kpa", "kPa"},   {"bar", "bar"}, {"mpa", "MPa"},
      {"pa", "Pa"}, {"hpa", "hPa"},     {"mbar", "mbar"}, {"psi", "psi"},   {"mm", "mm"},   {"cm", "cm"},
      {"m", "m"},   {"um", "um"},       {"µm", "um"},     {"inch", "inch"}, {"in", "inch"}, {"n", "N"},
      {"mn", "mN"}, {"kn", "kN"},       {"kgf", "kgf"},   {"kg", "kgf"},    {"lbf", "lbf"}, {"deg", "deg"},
      {"°", "deg"}, {"degrees", "deg"}, {"rad", "rad"},   {"v", "V"},       {"volt", "V"},  {"volts", "V"}};
  return words;
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string unitOfWord(std::string word) {
  word = lowerCase(word);
  if (word.size() > 2 && (word.front() == '(' || word.front() == '[')) word = word.substr(1, word.size() - 2);
  const auto found = unitWords().find(word);
  return found == unitWords().end() ? "" : found->second;
}

/// The unit in a name: "p [bar]", "time (s)", "pressure_kPa".
std::string unitInName(const std::string& name) {
  const auto open = name.find_last_of("([");
  if (open != std::string::npos) {
    const auto close = name.find_first_of(")]", open);
    return close == std::string::npos ? "" : unitOfWord(name.substr(open + 1, close - open - 1));
  }
  const auto underscore = name.find_last_of("_ ");
  return underscore == std::string::npos ? "" : unitOfWord(name.substr(underscore + 1));
}

bool isNumber(std::string_view text, char decimal) {
  double value = 0;
  bool is_out_of_range = false;
  return readNumber(text, decimal, value, is_out_of_range);
}

/// What a cell of a column of numbers may hold: a finite number, a mark of NaN, or something else.
enum class CellKind { number, missing, word };

CellKind kindOf(const DataTable& table, std::size_t row, std::size_t column, char decimal, double& value) {
  bool is_out_of_range = false;
  if (table.isMissing(row, column)) return CellKind::missing;
  if (!readNumber(table.text(row, column), decimal, value, is_out_of_range) || is_out_of_range) return CellKind::word;
  return std::isnan(value) ? CellKind::missing : std::isfinite(value) ? CellKind::number : CellKind::word;
}

/// Words that programs write where there is no reading, or none within the range of the instrument.
bool isMark(std::string_view word) {
  static const std::set<std::string> marks = {"-",      "--",   "---",   "?",        "*",   "na",   "n/a",  "#n/a",
                                              "n.a.",   "null", "none",  "missing",  "inf", "-inf", "+inf", "no data",
                                              "nodata", "err",  "error", "overflow", "ol",  "over"};
  return marks.contains(lowerCase(word));
}

/// The cells of one line; none if it cannot be split like this.
std::vector<std::string> cellsOf(const std::string& line, TableFormat format) {
  format.has_header = false;
  format.comment.clear();
  format.skip_before_header = format.skip_after_header = 0;
  std::vector<std::string> texts;
  try {
    CsvReader reader(line, "line", {}, format);
    std::vector<CsvCell> cells;
    if (reader.readRow(cells))
      for (const CsvCell& cell : cells) texts.emplace_back(cell.text);
  } catch (const BadFile&) {
  }
  while (!texts.empty() && texts.back().empty()) texts.pop_back();
  return texts;
}

/// Finds out how the text is written, line by line.
class FormatLook {
 public:
  explicit FormatLook(const std::string& text) {
    for (std::size_t begin = 0; begin < text.size() && lines_.size() < sampled_lines;) {
      const auto end = std::min(text.find('\n', begin), text.size());
      lines_.push_back(text.substr(begin, end - begin - (end > begin && text[end - 1] == '\r')));
      begin = end + 1;
    }
  }

  TableFormat format() {
    findSeparator();
    findNumberColumns();
    findHeader();
    return format_;
  }
  /// The row of units, or no cells.
  const std::vector<std::string>& units() const { return units_; }

 private:
  /// Takes the separator and the decimal sign that give the most numbers and the fewest texts in the second half of the lines.
  void findSeparator() {
    long best = 0;
    for (const char separator : {',', ';', '\t', '|', ' '})
      for (const char decimal : {'.', ','}) {
        if (separator == decimal) continue;
        TableFormat format = format_;
        format.separator = separator;
        format.decimal = decimal;
        long score = 0;
        for (std::size_t i = lines_.size() / 2; i < lines_.size(); ++i)
          for (const std::string& cell : cellsOf(lines_[i], format)) score += cell.empty() ? 0 : isNumber(cell, decimal) ? 2 : -1;
        if (score <= best) continue;
        best = score;
        format_ = format;
      }
  }

  /// A column is one of numbers if most of its cells in the second half of the lines are.
  void findNumberColumns() {
    std::vector<int> balance;
    for (std::size_t i = lines_.size() / 2; i < lines_.size(); ++i) {
      const auto cells = cellsOf(lines_[i], format_);
      balance.resize(std::max(balance.size(), cells.size()));
      for (std::size_t c = 0; c < cells.size(); ++c)
        if (!cells[c].empty() && !isMark(cells[c])) balance[c] += isNumber(cells[c], format_.decimal) ? 1 : -1;
    }
    for (const int value : balance) is_number_.push_back(value > 0);
  }

  /// A row of the table has at least one number, and no words in most of its columns of numbers.
  bool isRow(const std::string& line) const {
    const auto cells = cellsOf(line, format_);
    int numbers = 0, others = 0;
    for (std::size_t c = 0; c < std::min(cells.size(), is_number_.size()); ++c)
      if (is_number_[c] && !cells[c].empty() && !isMark(cells[c])) ++(isNumber(cells[c], format_.decimal) ? numbers : others);
    return numbers > others;
  }

  static bool isBlank(const std::string& line) { return line.find_first_not_of(" \t") == std::string::npos; }
  /// A line that begins with a sign of comments.
  static std::string commentSign(const std::string& line) {
    for (const char* sign : {"#", "%", "//"})
      if (line.starts_with(sign)) return sign;
    return "";
  }

  bool looksLikeUnits(const std::vector<std::string>& cells) const {
    int units = 0, words = 0;
    for (const std::string& cell : cells)
      if (!cell.empty() && !isNumber(cell, format_.decimal)) ++(unitOfWord(cell).empty() ? words : units);
    return units > 0 && units >= words;
  }

  void findHeader() {
    std::size_t first = 0;
    while (first < lines_.size() && (!commentSign(lines_[first]).empty() || !isRow(lines_[first]))) ++first;
    std::vector<std::size_t> heads, comments;
    for (std::size_t i = 0; i < std::min(first, lines_.size()); ++i)
      if (!isBlank(lines_[i])) (commentSign(lines_[i]).empty() ? heads : comments).push_back(i);
    if (!comments.empty()) format_.comment = commentSign(lines_[comments.back()]);
    if (heads.empty() && !comments.empty() &&
        cellsOf(lines_[comments.back()].substr(format_.comment.size()), format_).size() == is_number_.size() && is_number_.size() > 1)
      return takeHeader(comments.back(), true);
    if (heads.empty()) {
      format_.has_header = false;
      return;
    }
    const auto last = cellsOf(lines_[heads.back()], format_);
    const bool has_units = heads.size() > 1 && looksLikeUnits(last);
    if (has_units) units_ = last;
    const std::size_t header = has_units ? heads[heads.size() - 2] : heads.back();
    format_.skip_after_header = has_units ? static_cast<int>(heads.back() - header) : 0;
    takeHeader(header, header == heads.front());
  }

  void takeHeader(std::size_t line, bool is_first) {
    if (!commentSign(lines_[line]).empty()) {
      format_.comment.clear();
      is_first = line == 0;
    }
    format_.skip_before_header = is_first ? 0 : static_cast<int>(line);
  }

  std::vector<std::string> lines_, units_;
  std::vector<bool> is_number_;
  TableFormat format_;
};

/// The words of a column of numbers that stand for no reading: a few in less than half of the cells with something, or known marks.
std::set<std::string> wordsIn(const DataTable& table, std::size_t column, char decimal) {
  constexpr std::size_t most = 4;
  std::set<std::string> words;
  std::size_t word_count = 0, number_count = 0;
  double value = 0;
  for (std::size_t row = 0; row < table.rowCount(); ++row) {
    const CellKind kind = kindOf(table, row, column, decimal, value);
    number_count += kind == CellKind::number;
    word_count += kind == CellKind::word;
    if (kind == CellKind::word && words.size() <= most) words.emplace(table.text(row, column));
  }
  const bool are_few = words.size() <= most && word_count < number_count;
  const bool are_marks = number_count > 0 && words.size() <= most && std::ranges::all_of(words, isMark);
  return are_few || are_marks ? words : std::set<std::string>();
}

LookedColumn lookAtColumn(const DataTable& table, std::size_t index, const TableFormat& format) {
  LookedColumn column;
  column.name = table.names()[index];
  column.is_repeated = format.has_header && std::ranges::count(table.names(), column.name) > 1;
  column.is_named = format.has_header && !column.name.empty() && isUtf8(column.name) && !column.is_repeated;
  column.unit = unitInName(column.name);
  column.lowest = std::numeric_limits<double>::infinity();
  column.highest = -column.lowest;
  std::size_t number_count = 0, word_count = 0;
  for (std::size_t row = 0; row < table.rowCount(); ++row) {
    double value = 0;
    const CellKind kind = kindOf(table, row, index, format.decimal, value);
    if (column.example.empty() && kind != CellKind::missing) column.example = table.text(row, index);
    column.missing_count += kind == CellKind::missing;
    word_count += kind == CellKind::word;
    if (kind != CellKind::number) continue;
    ++number_count;
    column.lowest = std::min(column.lowest, value);
    column.highest = std::max(column.highest, value);
  }
  column.is_number = number_count > word_count;
  return column;
}

/// The first of these formats in which the text can be read; empty if there is none.
std::string firstFormat(const std::string& text, std::initializer_list<const char*> formats) {
  for (const char* format : formats)
    if (secondsSince1970(text, format)) return format;
  return "";
}

/// The format of a date and time, or of a time; empty if the text is neither.
std::string dateFormat(const std::string& text) {
  return firstFormat(text, {"%Y-%m-%d %H:%M:%S", "%Y-%m-%dT%H:%M:%S", "%Y-%m-%dT%H:%M:%S%z", "%d.%m.%Y %H:%M:%S", "%m/%d/%Y %H:%M:%S",
                            "%d/%m/%Y %H:%M:%S", "%H:%M:%S"});
}

std::string dayFormat(const std::string& text) {
  return firstFormat(text, {"%Y-%m-%d", "%d.%m.%Y", "%m/%d/%Y", "%d/%m/%Y"});
}

/// Whether the numbers of a column grow from row to row, but for a few turns of a counter. The clock of a column that is called so may be
/// coarse and stand still in most rows.
bool grows(const std::vector<double>& values, bool may_stand) {
  constexpr std::size_t rows_per_turn = 2, fewest_rows_per_turn = 50;
  std::size_t up = 0, down = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    up += values[i] > values[i - 1];
    down += values[i] < values[i - 1];
  }
  return up > 0 && up >= rows_per_turn * down && (may_stand || up * 2 >= values.size() - 1) &&
         down <= std::max<std::size_t>(1, values.size() / fewest_rows_per_turn);
}

/// A unit of time that fits numbers without one: from 1970, the row's number, or by the usual step.
std::string guessedTimeUnit(const std::vector<double>& values, double step) {
  for (const auto& [from, unit] : {std::pair<double, const char*>{1e17, "ns"}, {1e14, "us"}, {1e11, "ms"}, {1e8, "s"}})
    if (values.front() > from) return unit;
  const bool counts = values.size() > 2 && values.back() - values.front() == static_cast<double>(values.size() - 1) && step == 1;
  if (counts) return "";
  constexpr double slowest_s = 2, slowest_ms = 500;
  return step > slowest_ms ? "us" : step > slowest_s ? "ms" : "s";
}

class ClockLook {
 public:
  ClockLook(const DataTable& table, const TableLook& look) : table_(table), look_(look) {}

  std::optional<LookedClock> clock() {
    if (!findDate() && !findNumbers()) return std::nullopt;
    measure();
    return clock_;
  }

 private:
  bool findDate() {
    std::string day_format;
    for (std::size_t i = 0; i < look_.columns.size(); ++i) {
      const std::string& example = look_.columns[i].example;
      if (const std::string day = dayFormat(example); !day.empty()) {
        clock_.date_column = look_.columns[i].name;
        clock_.clock.date = {"", static_cast<int>(i) + 1};
        day_format = day;
      }
      clock_.clock.format = dateFormat(example);
      clock_.column = i;
      if (clock_.clock.format.empty()) continue;
      if (clock_.clock.format == "%H:%M:%S" && !day_format.empty())
        clock_.clock.format = day_format + " %H:%M:%S";
      else
        clock_.clock.date = {};
      if (clock_.clock.format == "%H:%M:%S") clock_.clock.wraps_at_s = 86400;
      return true;
    }
    clock_ = LookedClock();
    return false;
  }

  /// Prefers a column that is called time or has its unit.
  bool findNumbers() {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < look_.columns.size(); ++i) {
      const LookedColumn& column = look_.columns[i];
      const bool is_called_time =
          column.name == "t" || column.name.find("ime") != std::string::npos || column.name.find("stamp") != std::string::npos;
      const bool has_unit = column.unit == "s" || column.unit == "ms" || column.unit == "us" || column.unit == "ns" || column.unit == "min";
      const bool is_likely = is_called_time || has_unit;
      if (!is_likely && !column.unit.empty()) continue;  // degrees that grow are no time
      if (!column.is_number || !grows(present(i), is_likely)) continue;
      if (is_likely || !found) found = i;
      if (is_likely) break;
    }
    if (!found) return false;
    clock_.column = *found;
    clock_.unit = look_.columns[*found].unit;
    const std::vector<double> values = present(*found);
    if (clock_.unit.empty()) {
      clock_.unit = guessedTimeUnit(values, usualStep(values));
      clock_.unit_is_guessed = true;
    }
    static const std::map<std::string, double> factors = {{"", 1}, {"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}, {"min", 60}};
    if (!factors.contains(clock_.unit)) clock_.unit = "s";
    clock_.clock.factor = factors.at(clock_.unit);
    findTurns(values);
    return true;
  }

  /// A counter of 16 or 32 bits, or of a day, begins again near its largest value.
  void findTurns(const std::vector<double>& values) {
    double largest = 0;
    for (std::size_t i = 1; i < values.size(); ++i)
      if (values[i] < values[i - 1]) largest = std::max(largest, values[i - 1]);
    if (largest == 0) return;
    const double largest_s = largest * clock_.clock.factor;
    for (const double turn_s : {65536 * clock_.clock.factor, 65.536, 4294.967296, 4294967.296, 4294967296 * clock_.clock.factor, 86400.0})
      if (largest_s < turn_s && largest_s > 0.98 * turn_s) clock_.clock.wraps_at_s = turn_s;
  }

  std::vector<double> present(std::size_t column) const {
    std::vector<double> values;
    for (std::size_t row = 0; row < table_.rowCount(); ++row) {
      double value = 0;
      if (kindOf(table_, row, column, look_.format.decimal, value) == CellKind::number) values.push_back(value);
    }
    return values;
  }

  void measure() {
    TableClock clock = clock_.clock;
    clock.from = {"", static_cast<int>(clock_.column) + 1};
    std::vector<double> times_s;
    try {
      std::vector<std::string> notes;
      times_s = rowTimes(table_, clock, notes);
    } catch (const BadFile& error) {
      clock_.fault = fmt::format("line {}: {}", error.line(), withoutPlace(error));
      for (char& c : clock_.fault)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
      return;
    }
    std::erase_if(times_s, [](double time_s) { return std::isnan(time_s); });
    if (times_s.empty()) return;
    clock_.step_s = usualStep(times_s);
    clock_.duration_s = times_s.back() - times_s.front();
    for (std::size_t i = 1; i < times_s.size(); ++i) {
      const double step_s = times_s[i] - times_s[i - 1];
      clock_.repeat_count += step_s == 0;
      clock_.gap_count += step_s > gap_steps * clock_.step_s;
      clock_.longest_gap_s = std::max(clock_.longest_gap_s, step_s);
    }
  }

  const DataTable& table_;
  const TableLook& look_;
  LookedClock clock_;
};

}  // namespace

TableLook lookAtTable(const std::string& file) {
  TableLook look;
  look.file = file;
  std::vector<std::string> units;
  if (!isMatlabFile(file)) {
    const std::string bytes = readTextFile(file, CsvLimits().file_bytes);
    const std::string encoding = isUtf8(bytes) || bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF") ? "" : "windows-1252";
    FormatLook format(toUtf8(bytes, encoding, file));
    look.format = format.format();
    look.format.encoding = encoding;
    units = format.units();
  }
  std::set<std::string> words;
  {
    const DataTable first(file, look.format);
    for (std::size_t i = 0; i < first.names().size(); ++i) words.merge(wordsIn(first, i, look.format.decimal));
  }
  look.format.missing.assign(words.begin(), words.end());
  const DataTable table(file, look.format);
  look.notes = table.notes();
  look.header_line = table.headerLine();
  look.row_count = table.rowCount();
  if (look.row_count == 0) throw BadFile(file, "no row of numbers can be recognised");
  look.first_line = table.line(0);
  look.last_line = table.line(look.row_count - 1);
  for (std::size_t i = 0; i < table.names().size(); ++i) {
    look.columns.push_back(lookAtColumn(table, i, look.format));
    if (i < units.size() && !unitOfWord(units[i]).empty()) look.columns.back().unit = unitOfWord(units[i]);
  }
  look.clock = ClockLook(table, look).clock();
  return look;
}

}  // namespace musclesim
