/// Pressure stage: a muscle loses air that a regulator of finite speed has to replace.
///     dp/dt = (u - p) / tau_r - k p^n,    tau_r = 0.05 s and n = 1 unless given
/// u delivered, p actual pressure, fractions of full scale; k = leak_per_s, tau_r = regulator_time_constant_s, n = flow_exponent: 1 for
/// laminar flow through a pore or for flow that is choked, 0.5 for a hole at little pressure (turbulent: flow with the root of the
/// pressure difference). p^(n-1) is taken at no less than 0.001. Held and n = 1, p = u / (1 + k tau_r). Exact for a u held over the step
/// and n = 1; otherwise p^(n-1) is that of the step's begin. Neutral: k = 0; then there is no regulator lag either, p = u. Range 0 .. 100
/// per s, usually 0.0003 .. 1: intact muscles up to 0.05, which shows with closed valve only; against a regulator about 0.1 and more
/// shows.  Source: mass balance with a loss by gauge pressure; losses of 3 % to 80 % in 120 s measured on muscles with closed valve; the
/// upper end is an estimate, a hole that takes 5 % of the pressure from a regulator of 0.05 s.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class Leak final : public MuscleRatioEffect {
 public:
  Leak(double leak_per_s, double regulator_time_constant_s, double flow_exponent)
      : leak_per_s_(leak_per_s), regulator_s_(regulator_time_constant_s), exponent_(flow_exponent) {}
  static EffectInfo info();

 private:
  double output(double input, const Moment& moment) override;
  double settled(double input) override;
  /// k p^(n-1)
  double lossPerS(double pressure) const;

  double leak_per_s_, regulator_s_, exponent_;
  double pressure_ = 0;
};

}  // namespace musclesim
