/// Pressure stage: a valve fills and vents the muscle with a lag.
///     ((1 - s) tau) dv/dt = u - v,    (s tau) dp/dt = v - p,    tau = fill_ or vent_time_constant_s
/// tau is that of filling while the pressure rises and that of venting otherwise. u delivered pressure, v pressure between valve and
/// muscle, p actual pressure, fractions of full scale; s = second_lag_share; s = 0 is a single lag with p = v. Exact if u is constant over
/// the step.
/// Neutral: both 0, p = u. Range 0 .. 5 s, usually 0.01 .. 0.2 s.  Source: first-order lag of valve and volume; time constants of 0.05 and
/// 0.084 s, 0.126 and 0.089 s (filling and venting) measured on two pneumatic muscle drives (see docs/reference/effects.md).
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class ValveLag final : public MuscleRatioEffect {
 public:
  ValveLag(double fill_time_constant_s, double vent_time_constant_s, double second_lag_share)
      : fill_s_(fill_time_constant_s), vent_s_(vent_time_constant_s), share_(second_lag_share) {}
  static EffectInfo info();

 private:
  double output(double input, const StepTime& time) override;
  double settled(double input) override { return valve_ = pressure_ = input; }

  double fill_s_, vent_s_, share_;
  double valve_ = 0, pressure_ = 0;
};

}  // namespace musclesim
