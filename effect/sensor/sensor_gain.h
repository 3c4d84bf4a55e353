/// Sensor stage: a reading is off by a factor.
///     y' = g y
/// g = gain.
/// Neutral: g = 1. Range -10 .. 10, usually 0.85 .. 1.15.  Source: definition.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class SensorGain final : public SensorEffect {
 public:
  explicit SensorGain(double gain) : gain_(gain) {}
  static EffectInfo info();

  double reading(double value, const StepTime&, long) override { return gain_ * value; }

 private:
  double gain_;
};

}  // namespace musclesim
