/// Command stage: the valve does not open for small commands.
///     u' = 0 for u < u_t,  u otherwise
/// u commanded, u' delivered pressure, fractions of full scale; u_t = threshold.
/// Neutral: u_t = 0. Range 0 .. 1, usually 0.02 .. 0.1.  Source: definition; 0.056 measured on a pneumatic muscle drive.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class CommandDeadBand final : public MuscleRatioEffect {
 public:
  explicit CommandDeadBand(double threshold) : threshold_(threshold) {}
  static EffectInfo info();

 private:
  double output(double input, const StepTime&) override { return settled(input); }
  double settled(double input) override { return input < threshold_ ? 0 : input; }

  double threshold_;
};

}  // namespace musclesim
