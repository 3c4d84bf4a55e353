#include "musclesim/robot/chou_hannaford.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "force_law_checks.h"
#include "musclesim/base/error.h"

namespace musclesim {

ChouHannafordConstants::ChouHannafordConstants(Parameters& p)
    : braid_N(p.number("force_law.braid_N", ChouHannafordConstants().braid_N, "N", -1e6, 1e6, "Chou-Hannaford: A, times p s^2")),
      bore_N(p.number("force_law.bore_N", ChouHannafordConstants().bore_N, "N", -1e6, 1e6, "Chou-Hannaford: B, times -p")),
      elastic_N(p.number("force_law.elastic_N", 0, "N", -1e6, 1e6, "Chou-Hannaford: C, times s - 1")),
      threshold_N(p.number("force_law.threshold_N", ChouHannafordConstants().threshold_N, "N", -1e6, 1e6, "Chou-Hannaford: D, subtracted")),
      stretch_N(p.number("force_law.stretch_N", ChouHannafordConstants().stretch_N, "N", -1e6, 1e6,
                         "Chou-Hannaford: E, times exp(beta (s - 1)); beyond s = 1 the tangent")),
      stretch_exponent(
          p.number("force_law.stretch_exponent", ChouHannafordConstants().stretch_exponent, "", 0, 1e3, "Chou-Hannaford: beta")) {}

ChouHannafordForceLaw::ChouHannafordForceLaw(double rest_length_mm, const ChouHannafordConstants& constants)
    : rest_length_mm_(rest_length_mm), constants_(constants) {
  const auto& [A, B, C, D, E, beta] = constants_;
  requireLengthAndConstants("the Chou-Hannaford law", rest_length_mm, {A, B, C, D, E, beta});
  if (beta < 0) throw BadParameter("force_law.stretch_exponent", fmt::format("{}", beta), "not be negative");
}

double ChouHannafordForceLaw::tensionN(double pressure_ratio, double length_mm) const {
  return std::max(0.0, formulaN(pressure_ratio, length_mm));
}

double ChouHannafordForceLaw::formulaN(double pressure_ratio, double length_mm) const {
  const auto& [A, B, C, D, E, beta] = constants_;
  const double p = pressure_ratio, s = length_mm / rest_length_mm_;
  return p * (A * s * s - B) + C * (s - 1) - D + E * exponentialUpTo0(beta * (s - 1));
}

}  // namespace musclesim
