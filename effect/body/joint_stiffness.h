/// Body stage: hoses and cables pull a joint to a rest angle.
///     torque = -k (q - q_0)
/// q joint angle in rad, k = stiffness_Nm_per_rad, q_0 = rest_deg.
/// Neutral: k = 0. Range 0 .. 1000 N m/rad, usually 0.05 .. 2.  Source: linear spring.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class JointStiffness final : public JointEffect {
 public:
  JointStiffness(double stiffness_Nm_per_rad, double rest_deg) : stiffness_(stiffness_Nm_per_rad), rest_deg_(rest_deg) {}
  static EffectInfo info();

  void apply(const StepTime&) override;

 private:
  double stiffness_, rest_deg_;
};

}  // namespace musclesim
