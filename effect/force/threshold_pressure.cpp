#include "threshold_pressure.h"

#include <algorithm>

namespace musclesim {

EffectInfo ThresholdPressure::info() {
  return {.id = "threshold_pressure",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "the bladder takes some pressure before the braid feels any",
          .equation = "F' = F(p', l), p' = max(0, p - p_t) / (1 - p_t)    p pressure, p_t = threshold",
          .signature = "kink in the static map, pressure itself is fine",
          .source = "dead band of bladder muscles; 0.05 to 0.12 of full scale measured",
          .parameters = {{"threshold", "", 0, 0, 0.9, 0.02, 0.15, "p_t, fraction of full scale"}},
          .make = [](const EffectValues& values) { return std::make_unique<ThresholdPressure>(values["threshold"]); }};
}

double ThresholdPressure::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  MuscleInput inside = input;
  inside.pressure_ratio = std::max(0.0, input.pressure_ratio - threshold_) / (1 - threshold_);
  return below(inside);
}

}  // namespace musclesim
