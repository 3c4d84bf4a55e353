/// Force stage: the bladder takes some pressure before the braid feels any.
///     F' = F(p', l),    p' = max(0, p - p_t) / (1 - p_t)
/// p pressure in the muscle, p' pressure that the force law sees, fractions of full scale; p_t = threshold; l length.
/// Neutral: p_t = 0. Range 0 .. 0.9, usually 0.02 .. 0.15.  Source: dead band of bladder muscles; 0.05 to 0.12 of full scale measured.
#pragma once

#include "musclesim/effect/catalogue.h"

namespace musclesim {

class ThresholdPressure final : public ForceEffect {
 public:
  explicit ThresholdPressure(double threshold) : threshold_(threshold) {}
  static EffectInfo info();

  double tensionN(const MuscleInput& input, const ForceBelow& below) const override;

 private:
  double threshold_;
};

}  // namespace musclesim
