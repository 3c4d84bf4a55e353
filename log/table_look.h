/// Recognises how an unknown table is written and what its columns may be, to begin a mapping with. A person has the last word.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "musclesim/log/import_mapping.h"

namespace musclesim {

struct LookedColumn {
  std::string name;
  bool is_named = false;     ///< the name tells it from all others
  bool is_repeated = false;  ///< another column has the name, too
  std::string unit;          ///< as it is written; empty: none is
  bool is_number = false;    ///< the cells with a reading are numbers
  double lowest = 0, highest = 0;
  std::size_t missing_count = 0;
  std::string example;  ///< the first cell with a reading
};

struct LookedClock {
  std::size_t column = 0;
  TableClock clock;        ///< without `from`
  std::string unit = "s";  ///< a unit of time in which the numbers may be; "" for the number of the row
  bool unit_is_guessed = false;
  double step_s = 0, duration_s = 0, longest_gap_s = 0;
  std::size_t gap_count = 0, repeat_count = 0;
  std::string fault;        ///< why the rows get no times by this clock, with the place; empty: they do
  std::string date_column;  ///< name of the date's column, where date and time stand apart
};

struct TableLook {
  std::string file;
  TableFormat format;
  int header_line = 0, first_line = 0, last_line = 0;
  std::size_t row_count = 0;
  std::vector<LookedColumn> columns;
  std::optional<LookedClock> clock;
  std::vector<std::string> notes;
};

/// Throws IoError, or BadFile if no table can be recognised.
TableLook lookAtTable(const std::string& file);

/// What was recognised, for people.
std::string lookText(const TableLook& look);
/// A mapping to complete: format and clock as recognised, the columns as comments with their ranges.
std::string mappingText(const TableLook& look);

}  // namespace musclesim
