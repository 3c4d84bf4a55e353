/// Force stage: the bladder needs some pressure before it presses on the braid.
///     F' = F(p', l),    p' = max(0, p - p_t) / (1 - p_t)                            for q = 0, a kink
///                       p' = (s(p) - s(0)) / (s(1) - s(0)),                         otherwise; the bladder yields gradually
///                       s(p) = q p_t ln(1 + exp((p - p_t) / (q p_t)))
/// p pressure in the muscle, p' pressure that the force law sees, fractions of full scale; p_t = threshold, q = softness; l length.
/// Neutral: p_t = 0. Range 0 .. 0.9, usually 0.02 .. 0.15; q 0 .. 2, usually 0 .. 0.6 (estimate).  Source: dead band of bladder muscles;
/// 0.05 to 0.12 of full scale measured.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class ThresholdPressure final : public ForceEffect {
 public:
  ThresholdPressure(double threshold, double softness) : threshold_(threshold), width_(threshold * softness) {}
  static EffectInfo info();

  double tensionN(const MuscleInput& input, const ForceBelow& below) const override;

 private:
  double softened(double pressure_ratio) const;
  double threshold_, width_;
};

}  // namespace musclesim
