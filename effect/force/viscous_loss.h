/// Force stage: a muscle resists the rate of its length.
///     F' = F + D,    tau dD/dt = B dl/dt - D,    tau = B / K,  K = 10 g / h^2
/// F tension, D loss in N, l length, B = damping_Ns_per_m, h internal step. K belongs to the method, not to the muscle: a stiffness that
/// keeps the steps stable for any B, about 100 N/mm at the usual step against less than 5 of the muscle; it grows without bound as h
/// shrinks. Neutral: B = 0. Range 0 .. 1e5 N s/m, usually 20 .. 3000 (a muscle as soft as those of the paper is overdamped above some
/// hundred). Source: Reynolds et al. 2003 measured 1570 (relaxing) to 2900 N s/m (contracting).
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class ViscousLoss final : public ForceEffect {
 public:
  ViscousLoss(double lengthening_Ns_per_m, double shortening_Ns_per_m);
  static EffectInfo info();

  double tensionN(const MuscleInput& input, const ForceBelow& below) const override;
  void advance(const MuscleInput& input) override;
  void reset() override { loss_N_ = step_s_ = 0; }

 private:
  /// D at the end of a step of h_s at this rate.
  double lossAfter(double rate_mm_per_s, double h_s) const;

  double lengthening_Ns_per_mm_, shortening_Ns_per_mm_;
  double loss_N_ = 0;  ///< D
  double step_s_ = 0;  ///< length of the last step
};

}  // namespace musclesim
