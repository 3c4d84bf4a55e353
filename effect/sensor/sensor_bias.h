/// Sensor stage: a reading is off by a constant.
///     y' = y + b
/// b = offset, in the unit of the signal.
/// Neutral: b = 0.  Source: definition.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class SensorBias final : public SensorEffect {
 public:
  explicit SensorBias(double offset) : offset_(offset) {}
  static EffectInfo info();

  double reading(double value, const StepTime&, long) override { return value + offset_; }

 private:
  double offset_;
};

}  // namespace musclesim
