/// Body stage: both stops of a joint are shifted.
///     low + d <= q <= high + d
/// q joint angle, d = offset_deg. Throws BadParameter for a joint without stops.
/// Neutral: d = 0. Range -90 .. 90 deg, usually -15 .. 15.  Source: definition.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class JointStopOffset final : public JointEffect {
 public:
  explicit JointStopOffset(double offset_deg) : offset_deg_(offset_deg) {}
  static EffectInfo info();

  void attach(const EffectPlace& place) override;

 private:
  double offset_deg_;
};

}  // namespace musclesim
