/// The numbers that every function must refuse.
#pragma once

#include <limits>

namespace musclesim {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double inf = std::numeric_limits<double>::infinity();

}  // namespace musclesim
