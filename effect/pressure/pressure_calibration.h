/// Pressure stage: the regulator's pressure differs from the requested pressure by a gain and an offset.
///     p' = max(0, gain p + offset)
/// p requested, p' actual pressure, fractions of full scale; a muscle's pressure cannot be below atmosphere.
/// Neutral: gain 1, offset 0. Range of gain 0 .. 5, usually 0.9 .. 1.1; of offset -1 .. 1, usually -0.05 .. 0.05.  Source: definition.
#pragma once

#include <algorithm>

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class PressureCalibration final : public MuscleRatioEffect {
 public:
  PressureCalibration(double gain, double offset) : gain_(gain), offset_(offset) {}
  static EffectInfo info();

 private:
  double output(double input, const StepTime&) override { return settled(input); }
  double settled(double input) override { return std::max(0.0, gain_ * input + offset_); }

  double gain_, offset_;
};

}  // namespace musclesim
