/// Pressure stage: flow through a choked valve limits how fast the pressure changes.
///     dp/dt = rate sat((u - p) / proportional_band),  sat(x) = max(-1, min(1, x))
///     rate = fill_rate_per_s for u > p,  vent_rate_per_s (1 - c + c (p + p_atm) / (1 + p_atm)) for u < p
/// u delivered, p actual pressure, fractions of full scale; p_atm = 0.17, the atmosphere at a full scale of 6 bar; c = vent_pressure_share.
/// With a band of 0, p follows u at once, but no faster than these rates. For c = 0 exact if u is constant over the step; else the rate is
/// that of the step's beginning.
/// Neutral: both rates infinite, p = u. Rates 0.01 .. infinity, usually 0.3 .. 2 per s; band 0 .. 0.5, usually 0.01 .. 0.03: with a wide
/// band the flow is a lag nearly everywhere, which is another effect (valve_lag). c 0 .. 1. Source: ISO 6358: choked mass flow through an
/// orifice is in proportion to the absolute pressure before it, whatever the pressure behind it; it falls to zero as the pressures become
/// equal. A supply keeps its pressure, so that filling goes on at one rate; a muscle that vents loses its own (c = 1) unless the valve
/// regulates the flow (c = 0). +7 and -2.7 bar/s at a full scale of 6 bar measured on a pneumatic muscle drive.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class FlowLimit final : public MuscleRatioEffect {
 public:
  FlowLimit(double fill_rate_per_s, double vent_rate_per_s, double proportional_band, double vent_pressure_share)
      : fill_per_s_(fill_rate_per_s), vent_per_s_(vent_rate_per_s), band_(proportional_band), pressure_share_(vent_pressure_share) {}
  static EffectInfo info();

 private:
  double output(double input, const StepTime& time) override;
  double settled(double input) override { return pressure_ = input; }
  double ventRatePerS() const;

  double fill_per_s_, vent_per_s_, band_, pressure_share_;
  double pressure_ = 0;
};

}  // namespace musclesim
