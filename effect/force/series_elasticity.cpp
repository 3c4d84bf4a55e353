#include "series_elasticity.h"

#include <cmath>

namespace musclesim {

EffectInfo SeriesElasticity::info() {
  return {.id = "series_elasticity",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "an elastic tendon between muscle and bone",
          .equation = "F' = F(p, l - x) = k x, x >= 0    F tension, l length of both, x stretch, k = stiffness_N_per_mm",
          .signature = "dead zone at low tension; the joint is softer",
          .source = "springs in series",
          .parameters = {{"stiffness_N_per_mm", "N/mm", unlimited, 0.01, unlimited, 5, 1000, "k"}},
          .make = [](const EffectValues& values) { return std::make_unique<SeriesElasticity>(values["stiffness_N_per_mm"]); }};
}

MuscleInput SeriesElasticity::inside(const MuscleInput& input, double stretch_mm) const {
  MuscleInput result = input;
  result.length_mm -= stretch_mm;
  if (step_s_ > 0) result.rate_mm_per_s -= (stretch_mm - stretch_before_mm_) / step_s_;
  return result;
}

double SeriesElasticity::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  constexpr double accuracy_mm = 1e-10;
  constexpr int round_limit = 100;
  // The difference between the muscle's and the tendon's tension falls with x. Regula falsi brackets x between a slack tendon and one that
  // carries the muscle's tension at x = 0.
  auto surplus = [&](double x) { return below(inside(input, x)) - stiffness_ * x; };
  double low_mm = 0, at_low = surplus(0), high_mm = at_low / stiffness_;
  stretch_mm_ = 0;
  if (!(at_low > 0)) return 0;
  double at_high = surplus(high_mm);
  for (int round = 0; round < round_limit && high_mm - low_mm > accuracy_mm; ++round) {
    stretch_mm_ = at_high < 0 ? low_mm + (high_mm - low_mm) * at_low / (at_low - at_high) : high_mm;
    const double here = surplus(stretch_mm_);
    if (std::abs(here) <= accuracy_mm * stiffness_) break;
    if (here > 0) {
      low_mm = stretch_mm_;
      at_low = here;
      at_high /= 2;  // Illinois method: halve the value at the end that stays
    } else {
      high_mm = stretch_mm_;
      at_high = here;
      at_low /= 2;
    }
  }
  return stiffness_ * stretch_mm_;
}

void SeriesElasticity::advance(const MuscleInput& input) {
  stretch_before_mm_ = stretch_mm_;
  step_s_ = input.time.h_s;
}

}  // namespace musclesim
