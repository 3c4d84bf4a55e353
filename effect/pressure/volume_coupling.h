/// Pressure stage: a muscle whose volume shrinks compresses its own air if the valve is too slow to let the air out.
///     dp/dt = (u - p) / tau - n (p + p_atm) (dV/dt) / V
///     V ~ 1 + v_0 - r^2,    r = (l - l_c) / (l_0 - l_c)
/// Where a valve lag or a leak acts on the muscle, the second term is one of that effect's equation, and tau is not used (MuscleAir).
/// u delivered, p actual pressure, fractions of full scale; n = polytropic_exponent, tau = regulator_time_constant_s, p_atm = 0.17 of full
/// scale (1 bar of 6), l length, l_0 the force law's rest length, l_c the length at which it stops pulling at full pressure (l_min of
/// Eq. 1). V is chosen, up to a factor, so that the work p dV equals the work of Eq. 1's tension c p r over dl; v_0 = rest_volume_ratio is
/// the volume at l_0 over the change of volume from l_c to l_0. Exact if u and dV/dt are constant over the step.
/// Neutral: n = 0, p = u. Range of n 0 .. 2, usually 1 (slow) .. 1.4 (fast, adiabatic).  Source: polytropic gas in a changing volume;
/// virtual work as in Chou and Hannaford 1996.
#pragma once

#include "muscle_air.h"

namespace musclesim {

class VolumeCoupling final : public MuscleAir {
 public:
  VolumeCoupling(double polytropic_exponent, double regulator_time_constant_s, double rest_volume_ratio)
      : exponent_(polytropic_exponent), regulator_s_(regulator_time_constant_s), rest_volume_ratio_(rest_volume_ratio) {}
  static EffectInfo info();

  void attach(const EffectPlace& place) override;

 private:
  /// With s = n (dV/dt) / V: loss s, gain -s p_atm.
  AirRate ownRate(double pressure) const override;
  double filled(double input, const StepTime& time) override;
  double settledAir(double input) override { return pressure_ = heldPressure(input, regulator_s_); }
  double relativeVolumeRatePerS() const;

  double exponent_, regulator_s_, rest_volume_ratio_;
  double contracted_mm_ = 0, range_mm_ = 1;  ///< l_c, l_0 - l_c
  double pressure_ = 0;
};

}  // namespace musclesim
