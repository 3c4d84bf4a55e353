/// Pressure stage: the supply pressure drops under the total demand of all muscles.
///     p_supply = 1 - droop (sum over muscles of max(0, s_i) + mean of u),    s_i: du_i/dt filtered with 0.2 s, per s
///     p_i = min(u_i, p_supply)
/// u delivered, p actual pressure, fractions of full scale. s_i = (u_i - w_i) / 0.2 s with dw_i/dt = (u_i - w_i) / 0.2 s.
/// Neutral: droop = 0. Range 0 .. 1 s, usually 0.02 .. 0.2.  Source: pressure drop over the supply's resistance; drops of 0.04 to 0.12 of
/// the supply measured over working cycles.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class SupplyDroop final : public RatioEffect {
 public:
  explicit SupplyDroop(double droop) : droop_(droop) {}
  static EffectInfo info();

  void apply(std::vector<double>& ratios, const StepTime& time) override;
  void settle(std::vector<double>& ratios) override;

 private:
  void limit(std::vector<double>& ratios) const;

  double droop_;
  std::vector<double> filtered_;  ///< w
};

}  // namespace musclesim
