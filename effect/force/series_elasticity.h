/// Force stage: a tendon between muscle and bone.
///     F' = F(p, l - x) = k x,    x >= 0: the tendon is slack where the muscle would push
/// F tension, l length of muscle and tendon together, x stretch of the tendon in mm, k = stiffness_N_per_mm. The tendon has no mass; each
/// step solves for x to 1e-10 mm.
/// Neutral: k infinite. Range 0.01 .. infinity N/mm, usually 5 .. 1000.  Source: springs in series.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class SeriesElasticity final : public ForceEffect {
 public:
  explicit SeriesElasticity(double stiffness_N_per_mm) : stiffness_(stiffness_N_per_mm) {}
  static EffectInfo info();

  double tensionN(const MuscleInput& input, const ForceBelow& below) const override;
  void advance(const MuscleInput& input) override;
  void settle(const MuscleInput&) override { step_s_ = 0; }

 private:
  /// Input of the muscle if the tendon is stretched by x.
  MuscleInput inside(const MuscleInput& input, double stretch_mm) const;

  double stiffness_;
  mutable double stretch_mm_ = 0;              ///< x found by the last tensionN()
  double stretch_before_mm_ = 0, step_s_ = 0;  ///< x at the start of the last step, and the step's length
};

}  // namespace musclesim
