/// Pressure stage: flow through a choked valve limits how fast the pressure changes.
///     dp/dt = fill_rate_per_s sat((u - p) / proportional_band)  for u > p, with vent_rate_per_s for u < p;  sat(x) = max(-1, min(1, x))
/// u delivered, p actual pressure, fractions of full scale. With a band of 0, p follows u at once, but no faster than -vent_rate_per_s ..
/// fill_rate_per_s. Exact if u is constant over the step.
/// Neutral: both rates infinite, p = u. Rates 0.01 .. infinity, usually 0.3 .. 2 per s; band 0 .. 0.5, usually 0.01 .. 0.03: with a wide
/// band the flow is a lag nearly everywhere, which is another effect (valve_lag). Source: choked mass flow through an orifice does not
/// depend on the downstream pressure; it falls to zero as the pressures become equal (ISO 6358). +7 and -2.7 bar/s at a full scale of 6 bar
/// measured on a pneumatic muscle drive.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class FlowLimit final : public MuscleRatioEffect {
 public:
  FlowLimit(double fill_rate_per_s, double vent_rate_per_s, double proportional_band)
      : fill_per_s_(fill_rate_per_s), vent_per_s_(vent_rate_per_s), band_(proportional_band) {}
  static EffectInfo info();

 private:
  double output(double input, const StepTime& time) override;
  double settled(double input) override { return pressure_ = input; }

  double fill_per_s_, vent_per_s_, band_;
  double pressure_ = 0;
};

}  // namespace musclesim
