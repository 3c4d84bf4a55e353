/// Force stage: a muscle is weaker or stronger than the force law says.
///     F' = g F
/// F tension in N, g = gain.
/// Neutral: g = 1. Range 0 .. 10, usually 0.7 .. 1.3.  Source: definition. Causes: ageing, another muscle type.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class ForceGain final : public ForceEffect {
 public:
  explicit ForceGain(double gain) : gain_(gain) {}
  static EffectInfo info();

  double tensionN(const MuscleInput& input, const ForceBelow& below) const override { return gain_ * below(input); }

 private:
  double gain_;
};

}  // namespace musclesim
