#include "muscle_air.h"

#include <algorithm>
#include <cmath>

namespace musclesim {

void MuscleAir::takeUp(MuscleAir& other) {
  terms_.push_back(&other);
  other.is_taken_up_ = true;
}

AirRate MuscleAir::rate(double pressure) const {
  AirRate sum = ownRate(pressure);
  for (const MuscleAir* term : terms_) {
    const AirRate one = term->ownRate(pressure);
    sum.loss_per_s += one.loss_per_s;
    sum.gain_per_s += one.gain_per_s;
  }
  return sum;
}

/// With x = h (1/tau + loss): p e^-x + h (u/tau + gain) (1 - e^-x)/x. x may be negative: a muscle may shrink faster than the valve lets air
/// out.
double MuscleAir::pressureAfter(double h_s, double pressure, double u, double time_constant_s) const {
  const AirRate rates = rate(pressure);
  const double x = h_s * (1 / time_constant_s + rates.loss_per_s);
  const double share = std::abs(x) > 1e-12 ? -std::expm1(-x) / x : 1;
  return std::max(0.0, pressure * std::exp(-x) + h_s * (u / time_constant_s + rates.gain_per_s) * share);
}

/// Solves p + tau loss(p) p = u; the left side grows with p.
double MuscleAir::heldPressure(double u, double time_constant_s) const {
  constexpr int halvings = 50;
  double low = 0, high = u;
  for (int i = 0; i < halvings; ++i) {
    const double middle = (low + high) / 2;
    (middle * (1 + rate(middle).loss_per_s * time_constant_s) < u ? low : high) = middle;
  }
  return high;
}

}  // namespace musclesim
