/// Pressure stage: flow through a choked valve limits how fast the pressure changes.
///     dp/dt = fill_rate_per_s sat((u - p) / proportional_band)  for u > p, with vent_rate_per_s for u < p;  sat(x) = max(-1, min(1, x))
/// u delivered, p actual pressure, fractions of full scale. A band of 0: as fast as u asks for, but within -vent_rate_per_s ..
/// fill_rate_per_s. Exact for a u held over the step.
/// Neutral: both rates infinite, p = u. Rates 0.01 .. infinity, usually 0.3 .. 2 per s; band 0 .. 0.5, usually 0 .. 0.1.
/// Source: mass flow through an orifice does not depend on the pressure behind it when choked and falls to nothing as the pressures become
/// equal (ISO 6358); +7 and -2.7 bar/s of 6 bar measured on a pneumatic muscle drive.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class FlowLimit final : public MuscleRatioEffect {
 public:
  FlowLimit(double fill_rate_per_s, double vent_rate_per_s, double proportional_band)
      : fill_per_s_(fill_rate_per_s), vent_per_s_(vent_rate_per_s), band_(proportional_band) {}
  static EffectInfo info();

 private:
  double output(double input, const Moment& moment) override;
  double settled(double input) override { return pressure_ = input; }

  double fill_per_s_, vent_per_s_, band_;
  double pressure_ = 0;
};

}  // namespace musclesim
