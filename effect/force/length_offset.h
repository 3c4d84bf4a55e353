/// Force stage: a muscle is mounted too long or too short.
///     F' = F(p, l + d)
/// F tension, l length, d = offset_mm: if positive, the muscle acts as if it were stretched by d more than in the model.
/// Neutral: d = 0. Range -500 .. 500 mm, usually -15 .. 15.  Source: definition.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class LengthOffset final : public ForceEffect {
 public:
  explicit LengthOffset(double offset_mm) : offset_mm_(offset_mm) {}
  static EffectInfo info();

  double tensionN(const MuscleInput& input, const ForceBelow& below) const override;

 private:
  double offset_mm_;
};

}  // namespace musclesim
