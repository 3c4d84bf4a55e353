/// Pressure stage: a regulator brings a change of pressure nearly to its end at once, and the rest slowly.
///     p = u - s (u - w),    tau dw/dt = u - w
/// u requested, p delivered pressure, fractions of full scale; s = share, tau = time_constant_s; w, the slow part, follows u with a lag.
/// Exact if u is constant over the step.
/// Neutral: s = 0. Range 0 .. 0.5, usually 0.02 .. 0.2: what makes more than half of a change late is a lag (valve_lag). tau 0.01 ..
/// 1000 s, usually 0.3 .. 3.  Source: first-order relaxation of the pressure error, as an integrating pilot stage or gas that cools after a
/// fast change leaves one; 2.5 % of a step between 0.5 and 4 s after it measured on a proportional valve with a fluidic muscle.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class RegulatorTail final : public MuscleRatioEffect {
 public:
  RegulatorTail(double share, double time_constant_s) : share_(share), time_constant_s_(time_constant_s) {}
  static EffectInfo info();

 private:
  double output(double input, const StepTime& time) override;
  double settled(double input) override { return slow_ = input; }

  double share_, time_constant_s_;
  double slow_ = 0;  ///< w
};

}  // namespace musclesim
