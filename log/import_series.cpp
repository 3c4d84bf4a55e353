#include "import_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "columns.h"
#include "import_clock.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double no_reading = std::numeric_limits<double>::quiet_NaN();

std::size_t countWithin(const std::vector<double>& times_s, double from_s, double until_s) {
  return static_cast<std::size_t>(std::ranges::count_if(times_s, [&](double t) { return t >= from_s && t <= until_s; }));
}

/// A factor that would make both clocks run as long.
std::string clockHint(double span_s, double other_span_s) {
  const std::pair<double, const char*> powers[] = {{1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}};
  constexpr double near = 3;
  for (const auto& [power, unit] : powers) {
    const double ratio = other_span_s / span_s / power, inverse = span_s / other_span_s / power;
    if (ratio > 1 / near && ratio < near) return fmt::format("; is its clock in {}? Then give time_factor = {:g}", unit, 1 / power);
    if (inverse > 1 / near && inverse < near) return fmt::format("; is the first table's clock in {}?", unit);
  }
  return "; its clock may need time_offset (s) or time_factor";
}

bool isTime(double time_s) {
  return !std::isnan(time_s);
}

}  // namespace

ImportSeries::ImportSeries(double constant) : time_s_{-std::numeric_limits<double>::infinity()}, values_{constant} {}

ImportSeries::ImportSeries(const ImportColumn& column, const DataTable& table, std::size_t table_column, const std::vector<double>& times_s,
                           const ImportMapping& mapping, Clock clock, std::vector<std::string>& notes)
    : clock_(clock), table_(&table), column_(table_column) {
  std::size_t empty_count = 0, clipped_count = 0, wrap_count = 0;
  double last_s = no_reading, last_cell = no_reading, turned = 0;
  for (std::size_t row = 0; row < times_s.size(); ++row) {
    const double cell = table.number(row, column_);
    if (column.unwrap && !std::isnan(cell)) {
      const double turns = std::isnan(last_cell) ? 0 : std::round((last_cell - cell) / *column.unwrap);
      turned += turns * *column.unwrap;
      wrap_count += turns != 0;
      last_cell = cell;
    }
    const double value = column.valueOf(cell + turned);
    if (!isTime(times_s[row]) || times_s[row] == last_s) continue;
    last_s = times_s[row];
    empty_count += std::isnan(value);
    clipped_count += column.isClipped(cell);
    if (std::isnan(value) || column.isClipped(cell)) continue;
    time_s_.push_back(last_s);
    values_.push_back(value);
    rows_.push_back(row);
  }
  if (empty_count > 0) notes.push_back(fmt::format("{}: {} of {} cells hold no reading", column.name, empty_count, times_s.size()));
  if (wrap_count > 0)
    notes.push_back(fmt::format("{}: begins again after {:g}, {} times; the readings count on", column.name, *column.unwrap, wrap_count));
  if (clipped_count > 0)
    notes.push_back(fmt::format("{}: {} of {} cells are where the sensor or the table clips, and are not measured", column.name,
                                clipped_count, times_s.size()));
  const double longest_s = std::max(gap_steps * usualStep(time_s_), mapping.step_s.value_or(0));
  longest_gap_s_ = mapping.longest_gap_s.value_or(longest_s) * (1 + 1e-9);
}

double ImportSeries::valueAt(double time_s, const ImportColumn& column, bool is_resampled) {
  const bool is_command = isCommand(column);
  const auto next = std::upper_bound(time_s_.begin(), time_s_.end(), time_s + same_time_s);
  const auto k = static_cast<std::size_t>(next - time_s_.begin());
  if (k > 0 && (time_s_[k - 1] >= time_s - same_time_s || std::isinf(time_s_[k - 1]))) return values_[k - 1];
  if (k == time_s_.size() && k > 0 && is_command) {
    held_count_ += clock_ == Clock::own;
    return values_[k - 1];
  }
  if (!is_command && clock_ == Clock::of_first_table && !is_resampled) return no_reading;  // the cell is empty
  if (k == 0 || k == time_s_.size()) {
    outside_count_ += !is_command;
    return no_reading;
  }
  if (!is_command && time_s_[k] - time_s_[k - 1] > longest_gap_s_) {
    ++gap_count_;
    return no_reading;
  }
  if (!column.linear) return values_[k - 1];
  const double share = (time_s - time_s_[k - 1]) / (time_s_[k] - time_s_[k - 1]);
  return (1 - share) * values_[k - 1] + share * values_[k];
}

void ImportSeries::requireOverlap(const ImportColumn& column, const std::vector<double>& clock) const {
  if (time_s_.empty()) return;
  const double from_s = *std::ranges::find_if(clock, isTime), until_s = *std::find_if(clock.rbegin(), clock.rend(), isTime);
  const std::string both = fmt::format("{}: its clock runs from {:.6g} to {:.6g} s, the first table's from {:.6g} to {:.6g} s",
                                       column.written, time_s_.front(), time_s_.back(), from_s, until_s);
  const std::string hint = clockHint(until_s - from_s, time_s_.back() - time_s_.front());
  if (time_s_.front() > until_s || time_s_.back() < from_s) throw BadFile(table_->file(), both + ": they do not overlap" + hint);
  if (isCommand(column) || time_s_.size() < 2 || until_s == from_s) return;
  if (countWithin(time_s_, from_s, until_s) < 2 || countWithin(clock, time_s_.front(), time_s_.back()) < 2)
    throw BadFile(table_->file(), both + ": fewer than two rows of one lie within the other" + hint);
}

/// A line that lost its end may still have a line end.
void ImportSeries::noteLastJump(const ImportColumn& column, std::vector<std::string>& notes) const {
  constexpr double jump_ratio = 0.5, earlier_steps = 5;
  if (values_.size() < 3 || isCommand(column)) return;
  double largest_step = 0;
  for (std::size_t i = 1; i + 1 < values_.size(); ++i) largest_step = std::max(largest_step, std::abs(values_[i] - values_[i - 1]));
  const double before = values_[values_.size() - 2], step = std::abs(values_.back() - before);
  if (step > jump_ratio * std::abs(before) && step > earlier_steps * largest_step && largest_step > 0)
    notes.push_back(fmt::format("{} jumps from {:.6g} to {:.6g} in the last row of {}: is the file cut there?", column.name, before,
                                values_.back(), table_->file()));
}

void ImportSeries::noteMissing(const ImportColumn& column, std::size_t row_count, std::vector<std::string>& notes) const {
  const std::string of = fmt::format("of {} rows", row_count);
  noteLastJump(column, notes);
  if (outside_count_ > 0)
    notes.push_back(fmt::format("{}: {} {} lie outside of its own times, {:.6g} .. {:.6g} s in {}, and are not measured", column.name,
                                outside_count_, of, time_s_.empty() ? 0 : time_s_.front(), time_s_.empty() ? 0 : time_s_.back(),
                                table_->file()));
  if (gap_count_ > 0)
    notes.push_back(fmt::format("{}: {} {} lie in gaps longer than {:.4g} s and are not measured (rows.longest_gap_s sets that length)",
                                column.name, gap_count_, of, longest_gap_s_));
  if (held_count_ > 0)
    notes.push_back(fmt::format("{}: {} {} come after the last command in {} and hold it", column.name, held_count_, of, table_->file()));
}

}  // namespace musclesim
