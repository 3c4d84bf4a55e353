/// Dry friction that acts like a spring before it slides, at any speed in the same way.
#pragma once

#include <algorithm>
#include <cmath>

namespace musclesim {

/// The share z of the full friction, -1 .. 1, after a further way of x presliding distances (of either sign):
///     dz = (1 - z sgn(dx))^i dx
/// i = 0: a spring that breaks away (one Maxwell slip element, Iwan 1966); i = 1: contacts break away one after the other, so that z
/// approaches 1 exponentially (Dahl 1968). 0 <= i <= 1. Exact.
inline double slid(double z, double x, double exponent) {
  if (exponent == 0) return std::clamp(z + x, -1.0, 1.0);
  // g = 1 - z sgn(dx) obeys dg = -g^i |dx|.
  const double direction = x < 0 ? -1 : 1, way = std::abs(x), before = std::max(0.0, 1 - direction * z);
  const double left = exponent == 1 ? before * std::exp(-way)
                                    : std::pow(std::max(0.0, std::pow(before, 1 - exponent) - (1 - exponent) * way), 1 / (1 - exponent));
  return direction * (1 - left);
}

}  // namespace musclesim
