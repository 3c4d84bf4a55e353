#include "unit_suffix.h"

#include <array>
#include <string_view>
#include <utility>

namespace musclesim::description {

std::string unitFromSuffix(const std::string& name) {
  // The longer suffixes come first, since "_mm" ends "_N_per_mm", too.
  using Suffix = std::pair<std::string_view, const char*>;
  static constexpr auto suffixes = std::to_array<Suffix>({{"_g_per_mm3", "g/mm^3"},
                                                          {"_N_per_mm", "N/mm"},
                                                          {"_Nm_per_rad", "N m/rad"},
                                                          {"_Nms_per_rad", "N m s/rad"},
                                                          {"_Ns_per_m", "N s/m"},
                                                          {"_kgm2", "kg m^2"},
                                                          {"_g_mm2", "g mm^2"},
                                                          {"_m_per_s2", "m/s^2"},
                                                          {"_mm", "mm"},
                                                          {"_deg", "deg"},
                                                          {"_kg", "kg"},
                                                          {"_g", "g"},
                                                          {"_Nm", "N m"},
                                                          {"_N", "N"},
                                                          {"_kPa", "kPa"},
                                                          {"_ms", "ms"},
                                                          {"_s", "s"}});
  for (const auto& [suffix, unit] : suffixes)
    if (name.ends_with(suffix)) return unit;
  return "";
}

}  // namespace musclesim::description
