/// Body stage: both stops of a joint are shifted, and give way like rubber.
///     g = 0:  low + d <= q <= high + d
///     g > 0:  torque = 1 N m ((max(0, low + d - q) / g)^1.5 - (max(0, q - high - d) / g)^1.5)
/// q joint angle in deg, d = offset_deg, g = give_deg: how far a stop gives way under 1 N m. A stop that gives way is elastic; a hard one
/// takes the joint's speed. Throws BadParameter for a joint without stops.
/// Neutral: d = 0 and g = 0. Ranges -90 .. 90 deg, usually -15 .. 15, and 0 .. 90 deg, usually 0.2 .. 15.
/// Source: definition; round elastic bodies, Hertz 1882.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class JointStopOffset final : public JointEffect {
 public:
  JointStopOffset(double offset_deg, double give_deg) : offset_deg_(offset_deg), give_deg_(give_deg) {}
  static EffectInfo info();

  void attach(const EffectPlace& place) override;
  void apply(const StepTime&) override;

 private:
  void setHardStops(double low_rad, double high_rad) const;
  double pushNm(double depth_deg) const;

  double offset_deg_, give_deg_;
  double low_deg_ = 0, high_deg_ = 0;  ///< of the shifted stops
};

}  // namespace musclesim
