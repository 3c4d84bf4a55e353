/// What one column of a table read over time, for importTable().
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "data_table.h"
#include "musclesim/log/import_mapping.h"

namespace musclesim {

/// Clocks that agree differ by rounding: 0.3 + 0.01 k is not the same number as a cell "0.57".
inline constexpr double same_time_s = 1e-6;

inline bool isCommand(const ImportColumn& column) {
  return column.name.starts_with("command_");
}

/// Readings in the recording's unit, at increasing times of the first table's clock.
class ImportSeries {
 public:
  enum class Clock { of_first_table, own };

  /// One value for all times.
  explicit ImportSeries(double constant);
  /// The cells of a table's column that hold a reading; of several rows with the same time the first. `times_s`: of the table's rows, NaN
  /// where a row has none. A distance of readings up to `mapping.step_s`, a row of the recording, is no gap. Adds notes on cells
  /// without a reading.
  ImportSeries(const ImportColumn& column, const DataTable& table, std::size_t table_column, const std::vector<double>& times_s,
               const ImportMapping& mapping, Clock clock, std::vector<std::string>& notes);

  const std::vector<double>& timesS() const { return time_s_; }
  /// Null for a constant.
  const DataTable* table() const { return table_; }
  std::size_t tableColumn() const { return column_; }
  /// The table's row of a reading.
  std::size_t tableRow(std::size_t reading) const { return rows_[reading]; }

  /// The value at a time: a reading, a straight line between two, or the last command. NaN where nothing was read; noteMissing() tells how
  /// often.
  double valueAt(double time_s, const ImportColumn& column, bool is_resampled);
  /// Two clocks that have hardly a row in common are not the same clock, and every value would be invented: throws BadFile then. `clock`:
  /// times of the first table's rows.
  void requireOverlap(const ImportColumn& column, const std::vector<double>& clock) const;
  void noteMissing(const ImportColumn& column, std::size_t row_count, std::vector<std::string>& notes) const;

 private:
  void noteLastJump(const ImportColumn& column, std::vector<std::string>& notes) const;

  std::vector<double> time_s_, values_;
  double longest_gap_s_ = std::numeric_limits<double>::infinity();
  Clock clock_ = Clock::own;
  const DataTable* table_ = nullptr;
  std::size_t column_ = 0;         ///< of the table
  std::vector<std::size_t> rows_;  ///< of the table, one per reading
  // Rows of the recording without a reading: outside of the series' own times, in its gaps, and commands held after its end.
  std::size_t outside_count_ = 0, gap_count_ = 0, held_count_ = 0;
};

}  // namespace musclesim
