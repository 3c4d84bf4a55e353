/// Force stage: the tension drifts over minutes because of temperature or wear.
///     F' = F max(0, 1 + r t)
/// F tension in N, t time since the start of the run in min, r = rate_per_min. While the run settles, t = 0.
/// Neutral: r = 0. Range -10 .. 10 per min, usually -0.05 .. 0.05.  Source: linear trend.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class ForceDrift final : public ForceEffect {
 public:
  explicit ForceDrift(double rate_per_min) : rate_per_min_(rate_per_min) {}
  static EffectInfo info();

  double tensionN(const MuscleInput& input, const ForceBelow& below) const override;

 private:
  double rate_per_min_;
};

}  // namespace musclesim
