#include "musclesim/log/import.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/log/csv.h"

namespace musclesim {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_rows = 10'000'000;

/// Values over time or over the row number.
struct Series {
  std::vector<double> time_s, values;
};

/// The requested columns of a CSV file.
class Table {
 public:
  Table(const std::string& file, const std::vector<std::string>& names)
      : file_(file), text_(readTextFile(file, CsvLimits{}.file_bytes)), names_(names), values_(names.size()) {
    CsvReader reader(text_, file);
    std::vector<std::size_t> places;
    for (const std::string& name : names) {
      const auto found = std::ranges::find(reader.header(), name, &CsvCell::text);
      if (found == reader.header().end()) throw BadFile(file, missing(name, reader.header()));
      places.push_back(static_cast<std::size_t>(found - reader.header().begin()));
    }
    std::vector<CsvCell> cells;
    while (reader.readRow(cells))
      for (std::size_t i = 0; i < places.size(); ++i) values_[i].push_back(reader.number(cells[places[i]], names[i]));
  }
  const std::vector<double>& operator[](const std::string& name) const {
    return values_[static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin())];
  }
  std::size_t rowCount() const { return values_.empty() ? 0 : values_.front().size(); }

 private:
  static std::string missing(const std::string& name, const std::vector<CsvCell>& header) {
    std::vector<std::string> known;
    for (const CsvCell& cell : header) known.emplace_back(cell.text);
    return fmt::format("has no column \"{}\", which the mapping names; it has {}", name, fmt::join(known, ", "));
  }
  std::string file_, text_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> values_;
};

/// The value of the series at a time: interpolated linearly, or the last value; outside its range the nearest value.
double valueAt(const Series& series, double time_s, bool linear) {
  const auto next = std::upper_bound(series.time_s.begin(), series.time_s.end(), time_s);
  const auto k = static_cast<std::size_t>(next - series.time_s.begin());
  if (k == 0) return series.values.front();
  if (k == series.time_s.size() || !linear) return series.values[k - 1];
  const double share = (time_s - series.time_s[k - 1]) / (series.time_s[k] - series.time_s[k - 1]);
  return share == 0 ? series.values[k - 1] : (1 - share) * series.values[k - 1] + share * series.values[k];
}

/// Builds the recording.
class Import {
 public:
  Import(const std::string& csv_file, const ImportMapping& mapping) : csv_file_(csv_file), mapping_(mapping) {
    for (const ImportColumn& column : mapping.columns)
      if (column.name == "time_s")
        time_ = &column;
      else
        columns_.push_back(&column);
    if (time_ == nullptr && !mapping.settle_s)
      throw BadFile(mapping.file,
                    "columns: time_s is missing; if each row is the reading at the end of a held command, give rows.settle_s, the time "
                    "each command was held");
    if (time_ != nullptr && mapping.settle_s) throw BadFile(mapping.file, "columns.time_s and rows.settle_s cannot both be given");
    if (time_ != nullptr && (time_->from.empty() || !time_->table.empty()))
      throw BadFile(mapping.file, "columns.time_s: must come from a column of the first table");
  }

  Recording recording() {
    read();
    if (mapping_.settle_s)
      settledRows();
    else if (mapping_.step_s)
      evenRows();
    else
      ownRows();
    cut();
    addRest();
    Recording result = parseRecording(text(), "recording from " + csv_file_, mapping_.sidecar_json, mapping_.file);
    result.file = csv_file_;
    result.notes.insert(result.notes.begin(), notes_.begin(), notes_.end());
    return result;
  }

 private:
  static bool isCommand(const ImportColumn& column) { return column.name.starts_with("command_"); }

  void read() {
    std::vector<std::string> names;
    if (time_ != nullptr) names.push_back(time_->from);
    for (const ImportColumn* column : columns_)
      if (!column->from.empty() && column->table.empty()) names.push_back(column->from);
    if (names.empty()) throw BadFile(mapping_.file, "columns: at least one must come from the table");
    const Table first(csv_file_, names);
    for (std::size_t row = 0; row < first.rowCount(); ++row)
      clock_.push_back(time_ != nullptr ? first[time_->from][row] * time_->factor + time_->offset : static_cast<double>(row));
    if (clock_.empty()) throw BadFile(csv_file_, "has no rows");
    for (const ImportColumn* column : columns_) {
      if (column->from.empty()) {
        series_.push_back({{clock_.front()}, {column->value}});
      } else if (column->table.empty()) {
        series_.push_back(scaled(*column, {clock_, first[column->from]}, csv_file_));
      } else {
        const std::string file = tableFile(csv_file_, *column);
        const Table other(file, {column->time, column->from});
        if (other.rowCount() == 0) throw BadFile(file, "has no rows");
        series_.push_back(scaled(*column, {other[column->time], other[column->from]}, file));
      }
    }
  }

  /// The series in the recording's unit, with increasing times: of several rows with the same time the first is kept.
  static Series scaled(const ImportColumn& column, const Series& raw, const std::string& file) {
    Series result;
    for (std::size_t row = 0; row < raw.values.size(); ++row) {
      if (!result.time_s.empty() && raw.time_s[row] == result.time_s.back()) continue;
      result.time_s.push_back(raw.time_s[row]);
      const double value = column.factor * raw.values[row] + column.offset;
      result.values.push_back(std::isnan(value) ? value : std::clamp(value, column.minimum, column.maximum));
    }
    for (std::size_t row = 1; row < result.time_s.size(); ++row)
      if (!(result.time_s[row] > result.time_s[row - 1]))
        throw BadFile(file,
                      fmt::format("time runs backwards in data row {}: {} after {}", row + 1, result.time_s[row], result.time_s[row - 1]));
    return result;
  }

  void addRow(double time_s, double clock, bool with_readings) {
    std::vector<double> row;
    for (std::size_t i = 0; i < columns_.size(); ++i)
      row.push_back(with_readings || isCommand(*columns_[i]) ? valueAt(series_[i], clock, columns_[i]->linear) : nan);
    time_s_.push_back(time_s);
    rows_.push_back(std::move(row));
  }

  /// Makes two rows of each step: one where its command begins, and one with the readings shortly before it ends.
  void settledRows() {
    constexpr double read_at = 0.95;
    const auto every = static_cast<std::size_t>(mapping_.every);
    for (std::size_t i = 0; i * every < clock_.size(); ++i) {
      const double step = clock_[i * every], number = static_cast<double>(i);
      addRow(number * *mapping_.settle_s, step, false);
      addRow((number + read_at) * *mapping_.settle_s, step, true);
    }
    notes_.push_back(
        fmt::format("the table has no time: each of {} rows is taken as the reading {:g} s after its command began, {:g} s long",
                    clock_.size(), read_at * *mapping_.settle_s, *mapping_.settle_s));
  }

  void evenRows() {
    const double start_s = mapping_.from_s.value_or(clock_.front()), span_s = clock_.back() - start_s;
    if (!(span_s / *mapping_.step_s < static_cast<double>(most_rows))) throw BadFile(mapping_.file, "rows.step_s: too small");
    const auto count = static_cast<long>(std::floor(span_s / *mapping_.step_s + 1e-9)) + 1;
    for (long i = 0; i < count; ++i) {
      const double time_s = start_s + static_cast<double>(i) * *mapping_.step_s;
      addRow(time_s, time_s, true);
    }
    notes_.push_back(fmt::format("rows every {:g} s, interpolated linearly between the table's {} rows", *mapping_.step_s, clock_.size()));
  }

  void ownRows() {
    std::size_t repeated_count = 0;
    for (std::size_t row = 0; row < clock_.size(); ++row) {
      if (row > 0 && clock_[row] == clock_[row - 1])
        ++repeated_count;
      else if ((row - repeated_count) % static_cast<std::size_t>(mapping_.every) == 0)
        addRow(clock_[row], clock_[row], true);
    }
    if (repeated_count > 0) notes_.push_back(fmt::format("{} rows have the same time as the row before and are left out", repeated_count));
  }

  void cut() {
    const double from_s = mapping_.from_s.value_or(time_s_.front());
    std::vector<double> kept_s;
    std::vector<std::vector<double>> kept;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      if (time_s_[row] < from_s || (mapping_.until_s && time_s_[row] > *mapping_.until_s)) continue;
      kept_s.push_back(time_s_[row] - from_s);
      kept.push_back(rows_[row]);
    }
    if (kept.empty()) throw BadFile(mapping_.file, "rows: from_s and until_s leave no rows");
    time_s_ = std::move(kept_s);
    rows_ = std::move(kept);
  }

  void addRest() {
    for (const auto& given : mapping_.before) {
      const auto is_it = [&](const ImportColumn* column) { return isCommand(*column) && column->name == given.first; };
      if (std::ranges::none_of(columns_, is_it))
        throw BadFile(mapping_.file, fmt::format("rows.before.{}: is not one of the command columns", given.first));
    }
    if (!mapping_.before_s) return;
    std::vector<double> rest;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const auto given = mapping_.before.find(columns_[i]->name);
      rest.push_back(given != mapping_.before.end() ? given->second : isCommand(*columns_[i]) ? rows_.front()[i] : nan);
    }
    for (double& time_s : time_s_) time_s += *mapping_.before_s;
    time_s_.insert(time_s_.begin(), 0);
    rows_.insert(rows_.begin(), std::move(rest));
  }

  std::string text() const {
    std::string text = "time_s";
    for (const ImportColumn* column : columns_) text += "," + column->name;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      text += fmt::format("\n{:.10g}", time_s_[row]);
      for (const double value : rows_[row]) text += std::isnan(value) ? "," : fmt::format(",{:.10g}", value);
    }
    return text + "\n";
  }

  const std::string& csv_file_;
  const ImportMapping& mapping_;
  const ImportColumn* time_ = nullptr;
  std::vector<const ImportColumn*> columns_;  ///< all columns but the time
  std::vector<double> clock_;                 ///< time of the first table's rows, or their numbers
  std::vector<Series> series_;                ///< per column
  std::vector<double> time_s_;
  std::vector<std::vector<double>> rows_;
  std::vector<std::string> notes_;
};

}  // namespace

std::string tableFile(const std::string& csv_file, const ImportColumn& column) {
  return (std::filesystem::path(csv_file).parent_path() / column.table).string();
}

Recording importTable(const std::string& csv_file, const ImportMapping& mapping) {
  return Import(csv_file, mapping).recording();
}

}  // namespace musclesim
