/// Pressure stage: a muscle loses air that a regulator of finite speed has to replace.
///     dp/dt = (u - p) / tau_r - k p,    tau_r = 0.05 s unless given
/// u delivered, p actual pressure, fractions of full scale; k = leak_per_s, tau_r = regulator_time_constant_s. Held, p = u / (1 + k tau_r).
/// Exact for a u held over the step. Neutral: k = 0; then there is no regulator lag either, p = u. Range 0 .. 100 per s, usually 0.0003 ..
/// 0.05.  Source: mass balance with a loss in proportion to gauge pressure; losses of 3 % to 80 % in 120 s measured on muscles with closed
/// valve.
#pragma once

#include "musclesim/effect/catalogue.h"

namespace musclesim {

class Leak final : public MuscleRatioEffect {
 public:
  Leak(double leak_per_s, double regulator_time_constant_s) : leak_per_s_(leak_per_s), regulator_s_(regulator_time_constant_s) {}
  static EffectInfo info();

 private:
  double output(double input, const Moment& moment) override;
  double settled(double input) override;

  double leak_per_s_, regulator_s_;
  double pressure_ = 0;
};

}  // namespace musclesim
