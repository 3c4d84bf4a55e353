/// Helpers shared by the force laws of measured muscles.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <string>

#include "musclesim/base/error.h"

namespace musclesim {

/// exp(x) for x <= 0, its tangent 1 + x above. It keeps a law measured up to its rest length from growing exponentially beyond it.
inline double exponentialUpTo0(double x) {
  return x <= 0 ? std::exp(x) : 1 + x;
}

/// Throws BadParameter unless the rest length is positive and finite and all constants are finite.
inline void requireLengthAndConstants(const std::string& law, double rest_length_mm, std::initializer_list<double> constants) {
  if (!(rest_length_mm > 0 && std::isfinite(rest_length_mm)))
    throw BadParameter("rest length of " + law, fmt::format("{} mm", rest_length_mm), "be positive and finite");
  for (const double constant : constants)
    if (!std::isfinite(constant)) throw BadParameter("a constant of " + law, fmt::format("{}", constant), "be finite");
}

}  // namespace musclesim
