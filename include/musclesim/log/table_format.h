/// How a table is written, how its columns are named and how its rows get their times.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

/// How a program wrote a table. In a foreign table quotes around cells are removed, comments and empty lines may stand anywhere, and empty
/// cells at the end of a row may be missing or too many.
struct TableFormat {
  bool is_foreign = true;            ///< false: the format of recordings
  char separator = ',';              ///< ' ' stands for any number of spaces and tabs
  char decimal = '.';                ///< or ','
  bool has_header = true;            ///< false: the columns have numbers only
  int skip_before_header = 0;        ///< lines
  int skip_after_header = 0;         ///< lines, for example one with units
  std::string comment = "#";         ///< begins lines to leave out; empty: there are none
  std::string encoding;              ///< as iconv names it, "latin1"; empty: UTF-8, or UTF-16 with a byte order mark
  std::vector<std::string> missing;  ///< cells that stand for no reading, besides empty ones and nan; "-999" also stands for -999.0
  std::string variable;              ///< MATLAB file: the table holds all arrays as long as this one; empty: most arrays

  /// The format of recordings.
  static TableFormat recording();
};

/// Names a column of a table: by its name in the header, or by its number from 1.
struct ColumnName {
  std::string name;
  int number = 0;
  bool empty() const { return name.empty() && number == 0; }
};

/// How the rows of a table get their times: time in s = factor * x + offset. x is a number, the seconds since 1970 of a date and time, or
/// the row's number from 0.
struct TableClock {
  ColumnName from;  ///< empty: the row's number
  double factor = 1, offset = 0;
  std::string format;     ///< of a date and time, as for strptime; seconds may have decimals. Empty: a number
  ColumnName date;        ///< where date and time are in two columns; read as "date time"
  double wraps_at_s = 0;  ///< a counter that begins again at 0 there; 0: it does not
};

}  // namespace musclesim
