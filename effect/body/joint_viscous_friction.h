/// Body stage: a joint resists in proportion to its speed.
///     torque = -b dq/dt
/// q joint angle in rad, b = damping_Nms_per_rad. The torque uses the speed at the start of the internal step, so it is stable while b h <
/// 2 I, I the moment of inertia about the joint.
/// Neutral: b = 0. Range 0 .. 10 N m s/rad, usually 0.005 .. 0.5.  Source: viscous part of the usual friction models, Armstrong-Helouvry,
/// Dupont and Canudas de Wit 1994.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class JointViscousFriction final : public JointEffect {
 public:
  explicit JointViscousFriction(double damping_Nms_per_rad) : damping_(damping_Nms_per_rad) {}
  static EffectInfo info();

  void apply(const StepTime&) override { addTorqueNm(-damping_ * rateRadPerS()); }

 private:
  double damping_;
};

}  // namespace musclesim
