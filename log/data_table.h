/// A table as any program may have written it: text with separators, or a MATLAB file. All readers of foreign tables use it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/error.h"
#include "musclesim/log/csv.h"

namespace musclesim {

/// An error's message without the place before it.
std::string withoutPlace(const BadFile& error);

class DataTable {
 public:
  /// Reads a file. Throws IoError, or BadFile with the place of what does not agree with the format. A last line without line end is left
  /// out with a note, since it may be cut.
  DataTable(const std::string& file, const TableFormat& format);
  /// The same from the bytes of a file with text.
  DataTable(std::string bytes, const std::string& file, const TableFormat& format);
  DataTable(const DataTable&) = delete;
  DataTable& operator=(const DataTable&) = delete;

  const std::string& file() const { return file_; }
  /// The names in the header; "1", "2", ... without one.
  const std::vector<std::string>& names() const { return names_; }
  /// The column's index from 0. Throws BadFile if it does not exist, or if several columns have its name.
  std::size_t indexOf(const ColumnName& column) const;

  /// A column's name for messages.
  std::string shownName(std::size_t column) const;

  std::size_t rowCount() const { return lines_.size(); }
  int line(std::size_t row) const { return lines_[row]; }
  int headerLine() const { return reader_->headerLine(); }
  std::string_view text(std::size_t row, std::size_t column) const;
  /// NaN where there is no reading. Throws BadFile if the cell is no number.
  double number(std::size_t row, std::size_t column) const;
  std::vector<double> numbers(std::size_t column) const;
  /// Whether the cell stands for no reading.
  bool isMissing(std::size_t row, std::size_t column) const { return reader_->isMissing(text(row, column)); }
  [[noreturn]] void refuse(std::size_t row, std::size_t column, const std::string& what) const;
  [[noreturn]] void refuseHeader(std::size_t column, const std::string& what) const;
  /// What was left out while reading.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Cell {
    std::uint32_t begin = 0, length = 0;
  };
  void read(std::string bytes, const TableFormat& format);
  void dropTornLine();
  void readHeader();
  void readRows();
  [[noreturn]] void refuseName(const std::string& name) const;
  CsvCell cellAt(std::size_t row, std::size_t column) const;

  std::string file_, text_;
  std::optional<CsvReader> reader_;  ///< of text_
  std::vector<std::string> names_;
  std::vector<int> header_columns_;  ///< places of the names in their line
  std::vector<Cell> cells_;          ///< row by row
  std::vector<int> lines_;
  std::vector<std::string> notes_;
};

}  // namespace musclesim
