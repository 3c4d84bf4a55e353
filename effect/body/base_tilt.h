/// Body stage: the robot does not stand upright.
///     g' = R_z(tilt_z_deg) R_x(tilt_x_deg) g
/// g gravity; R_x and R_z are right-handed rotations about the world's x and z axes. All positions stay in the robot's frame.
/// Neutral: both 0. Range -180 .. 180 deg, usually -8 .. 8.  Source: definition.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class BaseTilt final : public BodyEffect {
 public:
  BaseTilt(double tilt_x_deg, double tilt_z_deg) : tilt_x_deg_(tilt_x_deg), tilt_z_deg_(tilt_z_deg) {}
  static EffectInfo info();

  void attach(const EffectPlace& place) override;

 private:
  double tilt_x_deg_, tilt_z_deg_;
};

}  // namespace musclesim
