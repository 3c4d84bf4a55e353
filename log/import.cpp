#include "musclesim/log/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <list>

#include "columns.h"
#include "data_table.h"
#include "import_clock.h"
#include "import_series.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/text.h"
#include "sidecar.h"

namespace musclesim {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_rows = 10'000'000;
/// A clock that begins later than after three years counts from 1970, or from another year.
constexpr double epoch_s = 1e8;

/// A row of the recording: its time, and the time in the clock of the first table where its values come from.
struct RowTime {
  double time_s, clock_s;
  bool has_readings;
};

/// A file in the same folder as another.
std::string besides(const std::string& file, const std::string& name) {
  return (std::filesystem::path(file).parent_path() / name).string();
}

std::string memberOf(const ImportColumn& column) {
  return "columns." + column.written;
}

/// Whether the columns can be those of a recording with this sidecar; what is wrong with them is the mapping's fault.
void requireColumns(const ImportMapping& mapping) {
  std::vector<std::string> notes;
  const RecordingInfo info = parseSidecar(mapping.sidecar_json, mapping.file, {}, notes);
  std::vector<Column> columns;
  for (const ImportColumn& column : mapping.columns) try {
      const Column parsed = parseColumnName(column.name);
      fullScale(parsed, info);
      const auto twice = std::ranges::find(columns, parsed.name, &Column::name);
      if (twice != columns.end())
        throw BadParameter(
            fmt::format("is the same column as {}", mapping.columns[static_cast<std::size_t>(twice - columns.begin())].written));
      columns.push_back(parsed);
    } catch (const BadParameter& error) {
      mapping.refuse(memberOf(column), error.what());
    }
  try {
    requireCommands(columns);
  } catch (const BadParameter& error) {
    mapping.refuse("columns", error.what());
  }
}

/// Builds the recording.
class Import {
 public:
  Import(const std::string& csv_file, const ImportMapping& mapping) : csv_file_(csv_file), mapping_(mapping) {
    if (!mapping.clock && !mapping.settle_s)
      mapping.refuse("columns",
                     "time_s is missing; for rows of an even rate give time_s = { rate_Hz = ... }; if each row is the reading at the "
                     "end of a held command, give rows.settle_s, the time each command was held");
    if (mapping.clock && mapping.settle_s) mapping.refuse("rows.settle_s", "the columns have a time; both cannot be given");
    requireColumns(mapping);
  }

  Recording recording() {
    read();
    requireBeginning();
    std::vector<RowTime> rows = mapping_.settle_s ? settledRows() : mapping_.step_s ? evenRows() : ownRows();
    cut(rows);
    evaluate(rows);
    fillBefore();
    addRest();
    for (std::size_t i = 0; i < series_.size(); ++i) series_[i].noteMissing(mapping_.columns[i], rows_.size(), notes_);
    Recording result = parsed(text());
    result.file = csv_file_;
    result.notes.insert(result.notes.begin(), notes_.begin(), notes_.end());
    return result;
  }

 private:
  Recording parsed(const std::string& text) const {
    const std::string made = "recording";
    try {
      return parseRecording(text, made, mapping_.sidecar_json, mapping_.file);
    } catch (const BadFile& fault) {
      if (fault.file() != made) throw;
      if (fault.line() > 1) refuseAtOrigin(fault, text);
      throw BadFile(csv_file_, withoutPlace(fault));
    }
  }

  /// Refuses a cell of the made recording where the table or the mapping has it.
  [[noreturn]] void refuseAtOrigin(const BadFile& fault, const std::string& text) const {
    const auto row = static_cast<std::size_t>(fault.line()) - 2;
    std::size_t line = 0;
    for (int i = 1; i < fault.line(); ++i) line = text.find('\n', line) + 1;
    const auto cell = text.begin() + static_cast<std::ptrdiff_t>(line);
    const auto index = static_cast<std::size_t>(std::count(cell, cell + fault.column() - 1, ','));
    if (index == 0) throw BadFile(csv_file_, withoutPlace(fault));
    const ImportColumn& column = mapping_.columns[index - 1];
    const ImportSeries& series = series_[index - 1];
    const std::string what = withoutPlace(fault);
    if (!series.table()) mapping_.refuse(memberOf(column), what);
    const bool is_rest = std::isnan(clock_of_row_[row]);  // its commands are those of `before`, or of the first row
    const double clock_s = clock_of_row_[is_rest ? row + 1 : row] + same_time_s;
    const std::vector<double>& times_s = series.timesS();
    const auto next = std::ranges::upper_bound(times_s, clock_s);
    if ((is_rest && mapping_.before.contains(column.written)) || next == times_s.begin())
      mapping_.refuse("rows.before." + column.written, what);
    const DataTable& table = *series.table();
    const std::size_t table_row = series.tableRow(static_cast<std::size_t>(next - times_s.begin()) - 1);
    table.refuse(table_row, series.tableColumn(),
                 fmt::format("column {}: {} becomes {}", table.shownName(series.tableColumn()),
                             inQuotes(table.text(table_row, series.tableColumn())), what));
  }

  /// The column's index; a name that the table does not have is a fault of the mapping.
  std::size_t indexIn(const DataTable& table, const ColumnName& column, const std::string& member) const {
    try {
      return table.indexOf(column);
    } catch (const BadFile& error) {
      mapping_.refuse(member, error.what());
    }
  }

  const DataTable& table(const std::string& name) {
    for (const auto& [known, opened] : tables_)
      if (known == name) return opened;
    const auto format = mapping_.formats.find(name);
    const std::string file = name.empty() ? csv_file_ : besides(csv_file_, name);
    tables_.emplace_back(std::piecewise_construct, std::forward_as_tuple(name),
                         std::forward_as_tuple(file, format == mapping_.formats.end() ? mapping_.format : format->second));
    const DataTable& opened = tables_.back().second;
    notes_.insert(notes_.end(), opened.notes().begin(), opened.notes().end());
    if (opened.rowCount() == 0) throw BadFile(file, "has no rows");
    return opened;
  }

  const DataTable& otherTable(const ImportColumn& column) {
    try {
      if (!column.table.empty() && !isWithin(std::filesystem::path(csv_file_).parent_path().string(), column.table))
        mapping_.refuse(memberOf(column) + ".table",
                        fmt::format("{}: must lie in the folder of the first table or below, and be no link that leads elsewhere",
                                    inQuotes(column.table)));
      return table(column.table);
    } catch (const IoError& error) {
      mapping_.refuse(memberOf(column) + ".table", error.what());
    }
  }

  void read() {
    if (std::ranges::all_of(mapping_.columns, [](const ImportColumn& column) { return column.from.empty(); }))
      mapping_.refuse("columns", "at least one must come from the table");
    const DataTable& first = table("");
    clock_ = timesOf(first, mapping_.clock.value_or(TableClock{}), clockMember("columns."));
    const auto first_time = std::ranges::find_if(clock_, [](double time_s) { return !std::isnan(time_s); });
    if (first_time == clock_.end()) throw BadFile(csv_file_, "no row has a time");
    setZero(*first_time);
    const auto untimed_count = std::ranges::count_if(clock_, [](double time_s) { return std::isnan(time_s); });
    if (untimed_count > 0) notes_.push_back(fmt::format("{} rows have no time and are left out", untimed_count));
    for (const ImportColumn& column : mapping_.columns) {
      if (column.from.empty()) {
        series_.emplace_back(column.valueOf(0));
      } else if (!column.clock) {
        addSeries(column, first, clock_, ImportSeries::Clock::of_first_table);
      } else {
        const DataTable& other = otherTable(column);
        const bool is_own = mapping_.places.contains(memberOf(column) + ".time");
        const std::string of_table = clockMember(fmt::format("tables.{}.", column.table));
        std::vector<double> times_s = timesOf(other, *column.clock, is_own ? memberOf(column) + ".time" : of_table);
        if (countsFrom1970(times_s)) shift(times_s);
        addSeries(column, other, times_s, ImportSeries::Clock::own);
        series_.back().requireOverlap(column, clock_);
      }
    }
    std::erase_if(clock_, [](double time_s) { return std::isnan(time_s); });
  }

  void addSeries(const ImportColumn& column, const DataTable& table, const std::vector<double>& times_s, ImportSeries::Clock clock) {
    series_.emplace_back(column, table, indexIn(table, column.from, memberOf(column)), times_s, mapping_, clock, notes_);
  }

  /// The member of the mapping that gives a clock, among those that begin so.
  std::string clockMember(const std::string& beginning) const {
    for (const auto& [member, place] : mapping_.places)
      if (member.starts_with(beginning + "time_") && member.find('.', beginning.size()) == std::string::npos) return member;
    return beginning + "time_s";
  }

  std::vector<double> timesOf(const DataTable& table, const TableClock& clock, const std::string& member) {
    for (const ColumnName& column : {clock.from, clock.date})
      if (!column.empty()) indexIn(table, column, member);
    return rowTimes(table, clock, notes_);
  }

  /// A clock beside one that counts from 1970 may count from elsewhere: then its times, with their offset, are those after the first row.
  static bool countsFrom1970(const std::vector<double>& times_s) {
    const auto first = std::ranges::find_if(times_s, [](double time_s) { return !std::isnan(time_s); });
    return first != times_s.end() && std::abs(*first) >= epoch_s;
  }

  /// A clock that counts from 1970 begins at 0 in the recording.
  void setZero(double first_s) {
    if (std::abs(first_s) < epoch_s) return;
    zero_s_ = first_s;
    shift(clock_);
    notes_.push_back(fmt::format("the clock begins at {:.3f} s; that becomes time 0", first_s));
  }

  /// Counted from 1970, a double tells microseconds.
  void shift(std::vector<double>& times_s) const {
    constexpr double per_s = 1e6;
    if (zero_s_ == 0) return;
    for (double& time_s : times_s) time_s = std::round((time_s - zero_s_) * per_s) / per_s;
  }

  /// Makes two rows of each step: one where its command begins, and one with the readings shortly before it ends.
  std::vector<RowTime> settledRows() {
    constexpr double read_at = 0.95;
    std::vector<RowTime> rows;
    const auto every = static_cast<std::size_t>(mapping_.every);
    for (std::size_t i = 0; i * every < clock_.size(); ++i) {
      const double step = clock_[i * every], number = static_cast<double>(i);
      rows.push_back({number * *mapping_.settle_s, step, false});
      rows.push_back({(number + read_at) * *mapping_.settle_s, step, true});
    }
    notes_.push_back(
        fmt::format("the table has no time: each of {} rows is taken as the reading {:g} s after its command began, {:g} s long",
                    clock_.size(), read_at * *mapping_.settle_s, *mapping_.settle_s));
    return rows;
  }

  std::vector<RowTime> evenRows() {
    std::vector<RowTime> rows;
    const double start_s = mapping_.from_s.value_or(clock_.front()), span_s = clock_.back() - start_s;
    if (!(span_s / *mapping_.step_s < static_cast<double>(most_rows))) mapping_.refuse("rows.step_s", "too small");
    const auto count = static_cast<long>(std::floor(span_s / *mapping_.step_s + 1e-9)) + 1;
    for (long i = 0; i < count; ++i) {
      const double time_s = start_s + static_cast<double>(i) * *mapping_.step_s;
      rows.push_back({time_s, std::clamp(time_s, clock_.front(), clock_.back()), true});
    }
    notes_.push_back(fmt::format("rows every {:g} s, interpolated linearly between the table's {} rows", *mapping_.step_s, clock_.size()));
    return rows;
  }

  std::vector<RowTime> ownRows() {
    std::vector<RowTime> rows;
    std::size_t repeated_count = 0;
    for (std::size_t row = 0; row < clock_.size(); ++row) {
      if (row > 0 && clock_[row] == clock_[row - 1])
        ++repeated_count;
      else if ((row - repeated_count) % static_cast<std::size_t>(mapping_.every) == 0)
        rows.push_back({clock_[row], clock_[row], true});
    }
    if (repeated_count > 0) notes_.push_back(fmt::format("{} rows have the same time as the row before and are left out", repeated_count));
    return rows;
  }

  /// Refuses a beginning before the table's own by more than a usual step.
  void requireBeginning() const {
    const double first_s = mapping_.settle_s ? 0 : clock_.front();
    if (!mapping_.from_s || *mapping_.from_s >= first_s || *mapping_.from_s > first_s - usualStep(clock_)) return;
    mapping_.refuse("rows.from_s",
                    fmt::format("{:g}: the table begins at {:g} s; for a rest before it give rows.before_s", *mapping_.from_s, first_s));
  }

  void cut(std::vector<RowTime>& rows) const {
    const double from_s = mapping_.from_s.value_or(rows.empty() ? 0 : rows.front().time_s);
    std::erase_if(rows, [&](const RowTime& row) { return row.time_s < from_s || (mapping_.until_s && row.time_s > *mapping_.until_s); });
    constexpr double per_s = 1e9;  // rounded to nanoseconds, since differences of large times have digits of no meaning
    for (RowTime& row : rows) row.time_s = std::round((row.time_s - from_s) * per_s) / per_s;
    if (rows.empty()) mapping_.refuse("rows", "from_s and until_s leave no rows");
  }

  void evaluate(const std::vector<RowTime>& rows) {
    for (const RowTime& row : rows) {
      std::vector<double> values;
      for (std::size_t i = 0; i < series_.size(); ++i) {
        const ImportColumn& column = mapping_.columns[i];
        values.push_back(row.has_readings || isCommand(column) ? series_[i].valueAt(row.clock_s, column, mapping_.step_s.has_value())
                                                               : nan);
      }
      time_s_.push_back(row.time_s);
      clock_of_row_.push_back(row.clock_s);
      rows_.push_back(std::move(values));
    }
  }

  /// Rows before the first command of a column have the command that the mapping gives for before.
  void fillBefore() {
    for (std::size_t i = 0; i < series_.size(); ++i) {
      const ImportColumn& column = mapping_.columns[i];
      if (!isCommand(column) || !std::isnan(rows_.front()[i])) continue;
      const auto before = mapping_.before.find(column.written);
      if (series_[i].timesS().empty()) throw BadFile(series_[i].table()->file(), column.written + ": no cell holds a command");
      if (before == mapping_.before.end())
        throw BadFile(
            series_[i].table()->file(),
            fmt::format("{}: the first command comes at {:.6g} s, after the first row; give the command before it, rows.before = {{ {} = "
                        "... }}, or begin at rows.from_s = {:.6g}",
                        column.written, series_[i].timesS().front(), column.written, series_[i].timesS().front()));
      std::size_t count = 0;
      for (auto row = rows_.begin(); row != rows_.end() && std::isnan((*row)[i]); ++row, ++count)
        (*row)[i] = before->second * column.unit_factor;
      used_before_ = true;
      notes_.push_back(fmt::format("{}: {} rows before the first command have the one of rows.before", column.name, count));
    }
  }

  void addRest() {
    for (const auto& given : mapping_.before) {
      const auto is_it = [&](const ImportColumn& column) { return isCommand(column) && column.written == given.first; };
      if (std::ranges::none_of(mapping_.columns, is_it)) mapping_.refuse("rows.before." + given.first, "is not one of the command columns");
    }
    if (!mapping_.before.empty() && !mapping_.before_s && !used_before_)
      mapping_.refuse("rows.before", "needs rows.before_s, the time the plant rested");
    if (!mapping_.before_s) return;
    std::vector<double> rest;
    for (std::size_t i = 0; i < series_.size(); ++i) {
      const ImportColumn& column = mapping_.columns[i];
      const auto given = mapping_.before.find(column.written);
      rest.push_back(given != mapping_.before.end() ? given->second * column.unit_factor : isCommand(column) ? rows_.front()[i] : nan);
    }
    for (double& time_s : time_s_) time_s += *mapping_.before_s;
    time_s_.insert(time_s_.begin(), 0);
    clock_of_row_.insert(clock_of_row_.begin(), nan);
    rows_.insert(rows_.begin(), std::move(rest));
  }

  std::string text() const {
    std::string text = "time_s";
    for (const ImportColumn& column : mapping_.columns) text += "," + column.name;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      text += fmt::format("\n{}", time_s_[row]);
      for (const double value : rows_[row]) text += std::isnan(value) ? "," : fmt::format(",{:.10g}", value);
    }
    return text + "\n";
  }

  const std::string& csv_file_;
  const ImportMapping& mapping_;
  std::list<std::pair<std::string, DataTable>> tables_;  ///< by name in the mapping; "" is the first
  std::vector<double> clock_;                            ///< time of the first table's rows, or their numbers
  double zero_s_ = 0;                                    ///< what the clocks read at time 0
  std::vector<ImportSeries> series_;                     ///< per column of the mapping
  std::vector<double> time_s_;
  std::vector<double> clock_of_row_;  ///< where a row's values come from, in the clock of the first table; NaN: the rest before it
  std::vector<std::vector<double>> rows_;
  std::vector<std::string> notes_;
  bool used_before_ = false;
};

}  // namespace

std::string tableFile(const std::string& csv_file, const ImportColumn& column) {
  return besides(csv_file, column.table);
}

Recording importTable(const std::string& csv_file, const ImportMapping& mapping) {
  return Import(csv_file, mapping).recording();
}

}  // namespace musclesim
