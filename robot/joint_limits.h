/// Limits that ODE can hold.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "musclesim/base/error.h"
#include "musclesim/robot/primitive.h"

namespace musclesim {

/// ODE measures joint angles between -180 and 180 degrees, and a stop that a fast body overshoots past 180 lets it through; so the stops
/// keep 5 degrees from there, which a body overshoots at more than 100 rad/s only.
inline constexpr double farthest_stop_deg = 175;
/// The same for the second Euler angle of a ball joint, which ODE measures between -90 and 90 degrees.
inline constexpr double farthest_middle_stop_deg = 85;

/// Throws BadParameter, naming the joint, unless the limits are finite, in order, contain 0 and are no farther than the engine can hold.
inline void requireLimits(const std::string& joint, Limits limits, double farthest_deg = farthest_stop_deg) {
  const std::string what = "limits of " + joint, given = fmt::format("{} .. {} deg", limits.low_deg, limits.high_deg);
  const bool in_order = std::isfinite(limits.low_deg) && std::isfinite(limits.high_deg) && limits.low_deg <= limits.high_deg;
  if (!in_order) throw BadParameter(what, given, "be finite and in order");
  if (limits.low_deg < -farthest_deg || limits.high_deg > farthest_deg)
    throw BadParameter(what, given, fmt::format("lie in {} .. {} deg, where the engine can hold them", -farthest_deg, farthest_deg));
  if (limits.low_deg > 0 || limits.high_deg < 0) throw BadParameter(what, given, "contain 0 deg, the angle of the pose as built");
}

}  // namespace musclesim
