/// What the force laws of measured muscles have in common.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <string>

#include "musclesim/base/error.h"

namespace musclesim {

/// exp(x) up to 0, its tangent 1 + x beyond: a law measured up to its rest length shall not explode when a robot stretches it further.
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
