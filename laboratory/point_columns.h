/// Finds the columns of pressure, length and force in a table of static points, with their units.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "data_table.h"
#include "musclesim/log/import.h"
#include "static_points.h"

namespace musclesim {

/// One quantity in one column, or the same in all rows.
struct PointColumn {
  ImportColumn source;
  std::optional<std::size_t> index;  ///< in the table; none for a constant
  double factor = 1;                 ///< converts to fractions or kPa, mm, N
  double lowest = 0, highest = 0;    ///< plausible range in the unit
  std::string unit, hint;            ///< hint: what a value out of range may mean

  /// The value in fractions or kPa, mm, N; NaN for an empty cell. Throws BadFile with the value and the allowed range.
  double value(const DataTable& table, std::size_t row) const;
};

/// Finds the columns in a table. Throws BadFile where one is missing, named twice or without a unit.
class PointColumns {
 public:
  /// `mapped`: columns of a mapping file.
  PointColumns(const DataTable& table, const StaticPointsOptions& options, const std::vector<ImportColumn>& mapped);

  const PointColumn& pressure() const { return columns_[0]; }
  const PointColumn& length() const { return columns_[1]; }
  const PointColumn& force() const { return columns_[2]; }
  bool pressureHasUnit() const { return !columns_[0].unit.empty(); }
  /// Whether a row passes the filters.
  bool selects(std::size_t row) const;
  /// Columns that are neither used nor filtered by.
  std::vector<std::string> ignored() const;
  /// Mapped columns whose names have no unit, with the assumed unit.
  const std::vector<std::string>& assumed() const { return assumed_; }

 private:
  PointColumn find(const std::string& quantity, const StaticPointsOptions& options, const std::vector<ImportColumn>& mapped);
  PointColumn fromOption(const std::string& quantity, const std::string& written);
  PointColumn fromNames(const std::string& quantity) const;

  const DataTable& table_;
  std::vector<PointColumn> columns_;
  std::vector<std::pair<std::size_t, std::string>> filters_;
  std::vector<std::string> assumed_;
};

}  // namespace musclesim
