/// Units in which instruments write readings. Recordings know fewer; mappings and tables of static points know all of these.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace musclesim {

/// value in `base` = factor * value in `name`.
struct ReadingUnit {
  std::string_view quantity;  ///< "pressure", "length", "force", "time"
  std::string_view name;
  std::string_view base;  ///< kPa, mm, N, s
  double factor;
  bool in_recordings;  ///< columns of recordings may have this unit
};

const std::vector<ReadingUnit>& readingUnits();

/// The unit that ends a column's name, "pressure_0_psi" or "force_lbf"; null where the name has none of its quantity.
/// Commands have the units of pressures, positions of the hand and targets those of lengths.
const ReadingUnit* unitAtEnd(std::string_view column_name);

}  // namespace musclesim
