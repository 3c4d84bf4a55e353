/// The project's only CSV reader. It is strict; every error names file, line and column.
///
/// It accepts UTF-8 with or without byte order mark, lines ending in \n or \r\n, lines that begin with # before the header, one
/// header row, then rows with as many cells as the header. Spaces around a cell are ignored. Quotes and NUL bytes are refused.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

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
  CsvReader(std::string_view text, std::string file, const CsvLimits& limits = {});

  const std::vector<CsvCell>& header() const { return header_; }
  /// Line of the header row.
  int headerLine() const { return header_line_; }
  /// Fills `cells` with the next row; false at the end of the text. Empty lines are accepted at the end only.
  bool readRow(std::vector<CsvCell>& cells);
  /// The line that readRow read last (1 = first line of the file).
  int line() const { return line_; }

  /// The cell's number; NaN for an empty cell or "nan". Throws BadFile for text, infinities and numbers that no double can hold.
  double number(const CsvCell& cell, std::string_view column_name) const;
  /// Throws BadFile at the cell.
  [[noreturn]] void refuse(const CsvCell& cell, const std::string& what) const;

 private:
  bool nextLine(std::string_view& line);
  void split(std::string_view line, std::vector<CsvCell>& cells) const;
  void readHeader();
  void requirePlainText() const;
  [[noreturn]] void refuseAt(int line, std::size_t offset, const std::string& what) const;

  std::string file_;
  CsvLimits limits_;
  std::string_view rest_;
  std::vector<CsvCell> header_;
  std::size_t row_count_ = 0;
  int line_ = 0, header_line_ = 0;
};

}  // namespace musclesim
