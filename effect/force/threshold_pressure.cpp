#include "threshold_pressure.h"

#include <algorithm>
#include <cmath>

namespace musclesim {

EffectInfo ThresholdPressure::info() {
  return {
      .id = "threshold_pressure",
      .stage = Stage::force,
      .acts_on = {ComponentKind::muscle},
      .summary = "the bladder needs some pressure before it presses on the braid",
      .equation = "F' = F(p', l), p' = max(0, p - p_t) / (1 - p_t), without a kink for q > 0    p pressure, p_t = threshold, q = softness",
      .signature = "kink in the static map of tension; the pressure is as expected",
      .source = "dead band of bladder muscles; 0.05 to 0.12 of full scale measured",
      .parameters = {{"threshold", "", 0, 0, 0.9, 0.02, 0.15, "p_t, fraction of full scale"},
                     {"softness", "", 0, 0, 2, 0, 0.6, "q, width of the kink over p_t", true}},
      .make = [](const EffectValues& values) { return std::make_unique<ThresholdPressure>(values["threshold"], values["softness"]); }};
}

double ThresholdPressure::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  MuscleInput inside = input;
  inside.pressure_ratio = width_ > 0 ? (softened(input.pressure_ratio) - softened(0)) / (softened(1) - softened(0))
                                     : std::max(0.0, input.pressure_ratio - threshold_) / (1 - threshold_);
  return below(inside);
}

double ThresholdPressure::softened(double pressure_ratio) const {
  const double x = (pressure_ratio - threshold_) / width_;
  return width_ * (std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))));
}

}  // namespace musclesim
