#include "musclesim/robot/sarosi.h"

#include <algorithm>
#include <cmath>

#include "force_law_checks.h"
#include "musclesim/base/units.h"

namespace musclesim {

SarosiConstants::SarosiConstants(Parameters& p)
    : a1_N(p.number("force_law.a1_N", SarosiConstants().a1_N, "N", -1e6, 1e6, "Sarosi: a1, times p exp(a3 k)")),
      a2_N(p.number("force_law.a2_N", SarosiConstants().a2_N, "N", -1e6, 1e6, "Sarosi: a2, times exp(a3 k)")),
      a3(p.number("force_law.a3", SarosiConstants().a3, "", -1e3, 1e3, "Sarosi: a3, exponent per contraction k; below k = 0 the tangent")),
      a4_N(p.number("force_law.a4_N", SarosiConstants().a4_N, "N", -1e6, 1e6, "Sarosi: a4, times k p")),
      a5_N(p.number("force_law.a5_N", SarosiConstants().a5_N, "N", -1e6, 1e6, "Sarosi: a5, times p")),
      a6_N(p.number("force_law.a6_N", SarosiConstants().a6_N, "N", -1e6, 1e6, "Sarosi: a6")) {}

SarosiConstants SarosiConstants::ofEquation1(const BraunConstants& braun, double minimum_length_ratio) {
  // r = 1 - k / (1 - l_min/l_max) turns c p r + c a (1 - p) exp(b r) into the terms of Sarosi's law.
  const auto& [a, b, c_kgf, p_max] = braun;
  const double c_N = newton_per_kgf * c_kgf, range = 1 - minimum_length_ratio;
  const double vented_N = c_N * a * std::exp(b);
  SarosiConstants constants;
  constants.a1_N = -vented_N / p_max;
  constants.a2_N = vented_N;
  constants.a3 = -b / range;
  constants.a4_N = -c_N / p_max / range;
  constants.a5_N = c_N / p_max;
  constants.a6_N = 0;
  return constants;
}

SarosiForceLaw::SarosiForceLaw(double rest_length_mm, const SarosiConstants& constants)
    : rest_length_mm_(rest_length_mm), constants_(constants) {
  const auto& [a1, a2, a3, a4, a5, a6] = constants_;
  requireLengthAndConstants("Sarosi's law", rest_length_mm, {a1, a2, a3, a4, a5, a6});
}

double SarosiForceLaw::tensionN(double pressure_ratio, double length_mm) const {
  return std::max(0.0, formulaN(pressure_ratio, length_mm));
}

double SarosiForceLaw::formulaN(double pressure_ratio, double length_mm) const {
  const auto& [a1, a2, a3, a4, a5, a6] = constants_;
  const double p = pressure_ratio, k = 1 - length_mm / rest_length_mm_;
  const double exponential = k >= 0 ? std::exp(a3 * k) : 1 + a3 * k;
  return (a1 * p + a2) * exponential + a4 * k * p + a5 * p + a6;
}

}  // namespace musclesim
