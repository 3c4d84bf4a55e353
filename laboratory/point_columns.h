/// Finds the columns of pressure, length and force in a table of static points, with their units.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "musclesim/log/csv.h"
#include "static_points.h"

namespace musclesim {

/// One quantity in one column.
struct PointColumn {
  std::size_t index = 0;
  std::string name;
  double factor = 1;  ///< converts to fractions or kPa, mm, N
  double lowest = 0, highest = 0;
  std::string unit, hint;  ///< hint: what a value out of range may mean

  /// The value in fractions or kPa, mm, N; NaN for an empty cell. Throws BadFile with the value and the allowed range.
  double value(const CsvReader& reader, const std::vector<CsvCell>& cells) const;
};

/// Finds the columns in a header. Throws BadFile where one is missing, named twice or without a unit.
class PointColumns {
 public:
  PointColumns(const CsvReader& reader, const std::string& file, const StaticPointsOptions& options);

  const PointColumn& pressure() const { return columns_[0]; }
  const PointColumn& length() const { return columns_[1]; }
  const PointColumn& force() const { return columns_[2]; }
  bool pressureHasUnit() const { return !columns_[0].unit.empty(); }
  /// Whether a row passes the filters.
  bool selects(const std::vector<CsvCell>& cells) const;
  const std::vector<std::string>& ignored() const { return ignored_; }
  /// Mapped columns whose names have no unit, with the assumed unit.
  const std::vector<std::string>& assumed() const { return assumed_; }

 private:
  std::size_t indexOf(const std::string& name) const;
  PointColumn find(const std::string& quantity, const StaticPointsOptions& options);

  const CsvReader& reader_;
  std::string file_;
  std::vector<PointColumn> columns_;
  std::vector<std::pair<std::size_t, std::string>> filters_;
  std::vector<std::string> ignored_, assumed_;
};

}  // namespace musclesim
