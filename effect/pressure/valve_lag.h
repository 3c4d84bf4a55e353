/// Pressure stage: a valve fills and vents the muscle with a lag.
///     dp/dt = (u - p) / tau,    tau = fill_time_constant_s while u > p, vent_time_constant_s otherwise
/// u delivered, p actual pressure, fractions of full scale. Exact for a u held over the step.
/// Neutral: both 0, p = u. Range 0 .. 5 s, usually 0.01 .. 0.2 s.  Source: first-order lag of valve and volume; time constants of 0.05 and
/// 0.084 s, 0.126 and 0.089 s (filling and venting) measured on two pneumatic muscle drives (see docs/effects.md).
#pragma once

#include "musclesim/effect/catalogue.h"

namespace musclesim {

class ValveLag final : public MuscleRatioEffect {
 public:
  ValveLag(double fill_time_constant_s, double vent_time_constant_s) : fill_s_(fill_time_constant_s), vent_s_(vent_time_constant_s) {}
  static EffectInfo info();

 private:
  double output(double input, const Moment& moment) override;
  double settled(double input) override { return pressure_ = input; }

  double fill_s_, vent_s_;
  double pressure_ = 0;
};

}  // namespace musclesim
