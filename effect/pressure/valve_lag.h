/// Pressure stage: a valve fills and vents the muscle with a lag, or with three in series (valve, tube, volume), each faster than the last.
///     tau_k dp_k/dt = p_(k-1) - p_k,    tau_k = tau r^k / (1 + r + r^2),    k = 0, 1, 2,    tau = fill_ or vent_time_constant_s
/// p_-1 = u delivered pressure, p_2 actual pressure, fractions of full scale; tau, the sum of the three, is that of filling while
/// p_(k-1) > p_k and that of venting otherwise; r = next_lag_ratio; r = 0 is a single lag. The first lag is exact if u is constant over the
/// step, the others if their input changes at a constant rate, which makes an error of second order in the step.
///
/// A leak and a change of volume act in the first lag, the slowest (MuscleAir):
///     tau_0 dp_0/dt = u - p_0 + tau_0 (gain - loss p_0)
/// With a leak of rate k the pressure settles at u / (1 + k tau_0).
///
/// Neutral: both 0, p_2 = u. Range 0 .. 5 s, usually 0.01 .. 0.2 s; r 0 .. 1.  Source: first-order lag of valve and volume; time constants
/// of 0.05 and 0.084 s, 0.126 and 0.089 s (filling and venting) measured on two pneumatic muscle drives (see docs/reference/effects.md).
#pragma once

#include <array>

#include "muscle_air.h"

namespace musclesim {

class ValveLag final : public MuscleAir {
 public:
  ValveLag(double fill_time_constant_s, double vent_time_constant_s, double next_lag_ratio)
      : fill_s_(fill_time_constant_s), vent_s_(vent_time_constant_s), ratio_(next_lag_ratio) {}
  static EffectInfo info();
  bool isTerm() const override { return false; }

 private:
  AirRate ownRate(double) const override { return {}; }
  double filled(double input, const StepTime& time) override;
  double settledAir(double input) override;

  double fill_s_, vent_s_, ratio_;
  std::array<double, 3> pressures_{};  ///< behind each lag
};

}  // namespace musclesim
