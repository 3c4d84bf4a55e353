/// Command stage: the tubes or wires of two muscles are exchanged.
///     u_i' = u_j,  u_j' = u_i
/// u commanded, u' delivered pressure. The component muscle_i+muscle_j names the two muscles. There is no neutral setting: the effect is
/// either active or absent. Source: definition.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class ChannelSwap final : public RatioEffect {
 public:
  static EffectInfo info();

  void attach(const EffectPlace& place) override;
  void apply(std::vector<double>& ratios, const StepTime&) override { settle(ratios); }
  void settle(std::vector<double>& ratios) override { std::swap(ratios[first_], ratios[second_]); }

 private:
  std::size_t first_ = 0, second_ = 0;
};

}  // namespace musclesim
