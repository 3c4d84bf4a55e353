/// Body stage: a constant force on the hand (rig: on the load, where only y counts).
///     F = (force_x_N, force_y_N, force_z_N) at the hand's point, world frame
/// Neutral: all 0. Range -1e4 .. 1e4 N, usually -10 .. 10.  Source: definition.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class ExternalForce final : public HandEffect {
 public:
  explicit ExternalForce(const Vector& force_N) : force_N_(force_N) {}
  static EffectInfo info();

  void apply(const StepTime&) override { addForceN(force_N_); }

 private:
  Vector force_N_;
};

}  // namespace musclesim
