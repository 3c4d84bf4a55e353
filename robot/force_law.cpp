#include "musclesim/robot/force_law.h"

#include <fmt/format.h>

#include <cmath>

#include "equilibrium.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"

namespace musclesim {

double ForceLaw::stiffnessNPerMm(double pressure_ratio, double length_mm) const {
  constexpr double half_width_mm = 0.01;
  return (tensionN(pressure_ratio, length_mm + half_width_mm) - tensionN(pressure_ratio, length_mm - half_width_mm)) / (2 * half_width_mm);
}

std::optional<double> ForceLaw::contractedLengthMm() const {
  const std::optional<double> rest_mm = restLengthMm();
  if (!rest_mm) return {};
  const auto pull_N = [this](double length_mm) { return formulaN(1, length_mm); };
  return pull_N(*rest_mm) > 0 ? restFrom(pull_N, *rest_mm, 0, *rest_mm) : 0;
}

BraunConstants::BraunConstants(Parameters& parameters)
    : a(parameters.number("force_law.a", BraunConstants().a, "", -1e3, 1e3, "Eq. 1: share of the vented muscle's rubber force")),
      b(parameters.number("force_law.b", BraunConstants().b, "", -50, 50, "Eq. 1: exponent of the rubber force")),
      c_kgf(parameters.number("force_law.c_kgf", BraunConstants().c_kgf, "kgf", 0, 1e4, "Eq. 1: force at full length and pressure")),
      pressure_maximum_ratio(parameters.number("force_law.pressure_maximum_ratio", 1, "", 1e-3, 1e3, "Eq. 1: p_max, in the unit of p")) {}

BraunForceLaw::BraunForceLaw(double minimum_length_mm, double maximum_length_mm, const BraunConstants& constants)
    : l_min_mm_(minimum_length_mm), l_max_mm_(maximum_length_mm), constants_(constants) {
  if (!(minimum_length_mm >= 0 && minimum_length_mm < maximum_length_mm && std::isfinite(maximum_length_mm)))
    throw BadParameter("minimum and maximum length of a muscle", fmt::format("{}, {} mm", minimum_length_mm, maximum_length_mm),
                       "be in order and finite");
  const auto& [a, b, c, p_max] = constants_;
  if (!(std::isfinite(a) && std::isfinite(b) && std::isfinite(c) && std::isfinite(p_max) && p_max != 0))
    throw BadParameter("constants of Eq. 1", fmt::format("{}, {}, {} kgf, {}", a, b, c, p_max), "be finite, and p_max not 0");
}

double BraunForceLaw::tensionN(double pressure_ratio, double length_mm) const {
  const auto& [a, b, c, p_max] = constants_;
  const double p = pressure_ratio / p_max;
  const double r = (length_mm - l_min_mm_) / (l_max_mm_ - l_min_mm_);
  return newton_per_kgf * c * (p * r + a * (1 - p) * std::exp(b * r));  // Eq. 1
}

double BraunForceLaw::stiffnessNPerMm(double pressure_ratio, double length_mm) const {
  const auto& [a, b, c, p_max] = constants_;
  const double p = pressure_ratio / p_max;
  const double r = (length_mm - l_min_mm_) / (l_max_mm_ - l_min_mm_);
  return newton_per_kgf * c * (p + a * b * (1 - p) * std::exp(b * r)) / (l_max_mm_ - l_min_mm_);  // Eq. 1, derivative
}

}  // namespace musclesim
