/// Force stage: a muscle resists changes of its length in proportion to their speed.
///     F' = F + D,    tau dD/dt = B dl/dt - D,    tau = B / K,  K = 10 g / h^2
/// F tension, D loss in N, l length, B = damping_Ns_per_m, h internal step. K is a stiffness of the numerical method, not of the muscle: it
/// keeps the steps stable for any B. It is about 100 N/mm at the usual step, compared with less than 5 N/mm of the muscle, and grows
/// without bound as h shrinks.
/// Neutral: B = 0. Range 0 .. 1e5 N s/m, usually 20 .. 3000 (a muscle as soft as the paper's is overdamped above a few hundred). Source:
/// Reynolds et al. 2003 measured 1570 (relaxing) to 2900 N s/m (contracting).
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
