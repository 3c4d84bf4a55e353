/// Pressure stage: a muscle loses air, and a valve of finite speed replaces it.
///     dp/dt = (u - p) / tau_r - k p^n,    tau_r = 0.05 s and n = 1 unless given
/// Where a valve lag acts on the muscle, with no limited flow behind it, the loss is a term of the lag's equation (its first lag), and
/// tau_r is not used (MuscleAir). u delivered, p actual pressure, fractions of full scale; k = leak_per_s, tau_r =
/// regulator_time_constant_s, n = flow_exponent: 1 for laminar flow through a pore or for choked flow, 0.5 for a hole at low pressure
/// (turbulent flow grows with the root of the pressure difference). p^(n-1) is evaluated at p >= 0.001. For constant u and n = 1 p settles
/// at u / (1 + k tau_r). For n = 1 the step is exact if u is constant over it; otherwise p^(n-1) is taken at the start of the step.
/// Neutral: k = 0, which also removes the regulator's lag: p = u. Range 0 .. 100 per s, usually 0.0003 .. 1: intact muscles have up to
/// 0.05, which is visible only with a closed valve; with a regulator leaks are visible from about 0.1. Source: mass balance with a loss
/// driven by gauge pressure; losses of 3 % to 80 % in 120 s measured on muscles with a closed valve. The upper end is an estimate: a hole
/// that costs a regulator of 0.05 s 5 % of the pressure.
#pragma once

#include "muscle_air.h"

namespace musclesim {

class Leak final : public MuscleAir {
 public:
  Leak(double leak_per_s, double regulator_time_constant_s, double flow_exponent)
      : leak_per_s_(leak_per_s), regulator_s_(regulator_time_constant_s), exponent_(flow_exponent) {}
  static EffectInfo info();

 private:
  /// loss = k p^(n-1)
  AirRate ownRate(double pressure) const override;
  double filled(double input, const StepTime& time) override;
  double settledAir(double input) override { return pressure_ = heldPressure(input, regulator_s_); }

  double leak_per_s_, regulator_s_, exponent_;
  double pressure_ = 0;
};

}  // namespace musclesim
