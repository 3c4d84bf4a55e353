/// The project's only reader of tables as text. Every error names file, line and column.
///
/// A recording has the default format, and that is strict: UTF-8 with or without byte order mark, lines ending in \n or \r\n, lines that
/// begin with # before the header, one header row, then rows with as many cells as the header. Spaces around a cell are ignored. Quotes
/// and NUL bytes are refused. TableFormat describes how other programs write tables.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "musclesim/log/table_format.h"

namespace musclesim {

/// Size limits of a CSV file. A file beyond a limit is refused, never read in part.
struct CsvLimits {
  std::size_t file_bytes = std::size_t{512} << 20;
  std::size_t line_bytes = std::size_t{1} << 20;
  std::size_t row_count = 10'000'000;
  std::size_t column_count = 1000;
  std::size_t cell_count = 100'000'000;  ///< rows times columns: limits the memory that a small file of empty cells can need
};

/// One cell and its place. Lines and columns (in bytes, without the byte order mark) count from 1. `text` points into the text given to
/// CsvReader.
struct CsvCell {
  std::string_view text;
  int line = 0, column = 0;
};

/// Reads CSV text row by row. Every function throws BadFile if it refuses the text.
class CsvReader {
 public:
  /// `text` must outlive the reader; `file` is used in messages only. Reads up to and including the header row.
  CsvReader(std::string_view text, std::string file, const CsvLimits& limits = {}, const TableFormat& format = TableFormat::recording());

  /// Empty for a table without header.
  const std::vector<CsvCell>& header() const { return header_; }
  /// Line of the header row.
  int headerLine() const { return header_line_; }
  /// Fills `cells` with the next row; false at the end of the text. Empty lines of a recording are accepted at the end only.
  bool readRow(std::vector<CsvCell>& cells);
  /// Whether the row of a foreign table that readRow read last has fewer cells than the table has columns.
  bool rowIsShort() const { return row_is_short_; }
  /// The line that readRow read last (1 = first line of the file).
  int line() const { return line_; }

  /// Whether a cell's text stands for no reading.
  bool isMissing(std::string_view text) const;
  /// The cell's number; NaN for an empty cell, "nan" or a missing reading. Throws BadFile for text, infinities and numbers that no double
  /// can hold.
  double number(const CsvCell& cell, std::string_view column_name) const;
  /// Throws BadFile at the cell.
  [[noreturn]] void refuse(const CsvCell& cell, const std::string& what) const;

 private:
  bool nextLine(std::string_view& line);
  /// nextLine without comments and, in foreign tables, empty lines.
  bool nextContent(std::string_view& line);
  bool isComment(std::string_view line) const;
  void split(std::string_view line, std::vector<CsvCell>& cells) const;
  void addCell(std::string_view line, std::size_t begin, std::size_t end, std::vector<CsvCell>& cells) const;
  std::size_t endOfQuotes(std::string_view line, std::size_t begin) const;
  void readHeader();
  void skipLines(int count);
  void fitWidth(std::vector<CsvCell>& cells);
  void requireNames() const;
  void requireSeparators(std::string_view line) const;
  std::string helpFor(const CsvCell& cell) const;
  void requirePlainText() const;
  /// As refuse; for a foreign table says what helps.
  [[noreturn]] void refuseShape(const CsvCell& place, const std::string& what) const;
  [[noreturn]] void refuseAt(int line, std::size_t offset, const std::string& what) const;

  std::string file_;
  TableFormat format_;
  CsvLimits limits_;
  std::string_view rest_;
  std::vector<CsvCell> header_;
  std::vector<double> missing_numbers_;
  std::size_t width_ = 0;  ///< number of columns; 0 until the first row of a table without header
  std::size_t row_count_ = 0;
  bool row_is_short_ = false;
  int line_ = 0, header_line_ = 0;
};

/// Reads a number as from_chars does, with an optional plus sign and this decimal sign. Returns whether the whole text is a number; it may
/// be infinite or NaN.
bool readNumber(std::string_view text, char decimal, double& value, bool& is_out_of_range);

}  // namespace musclesim
