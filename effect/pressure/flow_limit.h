/// Pressure stage: flow through a choked valve limits how fast the pressure changes.
///     dp/dt = as fast as u asks for, but within -vent_rate_per_s .. fill_rate_per_s
/// u delivered, p actual pressure, fractions of full scale. Exact for a u held over the step.
/// Neutral: both infinite, p = u. Range 0.01 .. infinity, usually 0.3 .. 2 per s.  Source: mass flow through an orifice does not depend on
/// the pressure behind it when choked (ISO 6358); +7 and -2.7 bar/s of 6 bar measured on a pneumatic muscle drive.
#pragma once

#include "musclesim/effect/catalogue.h"

namespace musclesim {

class FlowLimit final : public MuscleRatioEffect {
 public:
  FlowLimit(double fill_rate_per_s, double vent_rate_per_s) : fill_per_s_(fill_rate_per_s), vent_per_s_(vent_rate_per_s) {}
  static EffectInfo info();

 private:
  double output(double input, const Moment& moment) override;
  double settled(double input) override { return pressure_ = input; }

  double fill_per_s_, vent_per_s_;
  double pressure_ = 0;
};

}  // namespace musclesim
