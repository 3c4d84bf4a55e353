/// The times of a table's rows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data_table.h"

namespace musclesim {

/// The time of each row in s by this clock; NaN for a row without one. Times may repeat. Adds a note where a counter began again.
/// Throws BadFile where a cell is no time, or where the time runs backwards.
std::vector<double> rowTimes(const DataTable& table, const TableClock& clock, std::vector<std::string>& notes);

/// The time of a text in a format of strptime, in s since 1970, or since midnight for a format without a date; seconds may have decimals.
/// Nothing if the text has another format.
std::optional<double> secondsSince1970(const std::string& text, const std::string& format);

/// The median of the steps between times that grow; 0 if there is none.
double usualStep(const std::vector<double>& times_s);

/// Times or readings further apart than this many usual steps have a gap between them: irregular loggers vary by two or three.
inline constexpr double gap_steps = 5;

}  // namespace musclesim
