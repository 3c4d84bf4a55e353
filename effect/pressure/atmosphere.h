/// Pressures are gauge pressures; flow and compression depend on absolute ones.
#pragma once

namespace musclesim {

inline constexpr double atmosphere_ratio = 0.17;  ///< the atmosphere as a fraction of a full scale of 6 bar

}  // namespace musclesim
