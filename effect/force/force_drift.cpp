#include "force_drift.h"

#include <algorithm>

#include "musclesim/base/units.h"

namespace musclesim {

EffectInfo ForceDrift::info() {
  return {.id = "force_drift",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "the tension drifts over minutes because of temperature or wear",
          .equation = "F' = F max(0, 1 + r t)    F tension, t time in min, r = rate_per_min",
          .signature = "the error grows or shrinks steadily over minutes",
          .source = "linear trend",
          .parameters = {{"rate_per_min", "1/min", 0, -10, 10, -0.05, 0.05, "r"}},
          .make = [](const EffectValues& values) { return std::make_unique<ForceDrift>(values["rate_per_min"]); }};
}

double ForceDrift::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  const double time_min = std::max(0.0, input.time.clock_s) / s_per_min;
  return below(input) * std::max(0.0, 1 + rate_per_min_ * time_min);
}

}  // namespace musclesim
