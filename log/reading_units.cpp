#include "reading_units.h"

#include "musclesim/base/units.h"

namespace musclesim {

const std::vector<ReadingUnit>& readingUnits() {
  static const std::vector<ReadingUnit> units = {
      {"pressure", "kPa", "kPa", 1, true},
      {"pressure", "bar", "kPa", kPa_per_bar, true},
      {"pressure", "MPa", "kPa", kPa_per_MPa, true},
      {"pressure", "Pa", "kPa", kPa_per_Pa, false},
      {"pressure", "hPa", "kPa", kPa_per_hPa, false},
      {"pressure", "mbar", "kPa", kPa_per_mbar, false},
      {"pressure", "psi", "kPa", kPa_per_psi, false},
      {"length", "mm", "mm", 1, true},
      {"length", "cm", "mm", mm_per_cm, true},
      {"length", "m", "mm", mm_per_m, true},
      {"length", "um", "mm", mm_per_um, false},
      {"length", "inch", "mm", mm_per_inch, false},
      {"force", "N", "N", 1, true},
      {"force", "mN", "N", N_per_mN, false},
      {"force", "kN", "N", N_per_kN, false},
      {"force", "kgf", "N", newton_per_standard_kgf, false},
      {"force", "lbf", "N", N_per_lbf, false},
      {"time", "s", "s", 1, true},
      {"time", "ms", "s", 1 / ms_per_s, false},
      {"time", "us", "s", s_per_us, false},
      {"time", "ns", "s", 1e-3 * s_per_us, false},
      {"time", "min", "s", s_per_min, false},
  };
  return units;
}

const ReadingUnit* unitAtEnd(std::string_view column_name) {
  const auto underscore = column_name.rfind('_');
  if (underscore == std::string_view::npos) return nullptr;
  std::string_view quantity = column_name.substr(0, column_name.find('_'));
  if (quantity == "command") quantity = "pressure";
  if (quantity == "hand" || quantity == "target") quantity = "length";
  for (const ReadingUnit& unit : readingUnits())
    if (unit.quantity == quantity && unit.name == column_name.substr(underscore + 1)) return &unit;
  return nullptr;
}

}  // namespace musclesim
