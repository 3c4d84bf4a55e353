/// Command stage: the valve does not open for small commands.
///     closed: u' = 0 until u >= u_t;  open: u' = u until u < (1 - h) u_t
/// u commanded, u' delivered pressure, fractions of full scale; u_t = threshold, h = hysteresis.
/// Neutral: u_t = 0, h = 0. Range 0 .. 1 each, u_t usually 0.02 .. 0.1, h 0 .. 0.5.  Source: definition; u_t = 0.056 measured on a
/// pneumatic muscle drive; a spool that sticks opens later than it closes.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class CommandDeadBand final : public MuscleRatioEffect {
 public:
  CommandDeadBand(double threshold, double hysteresis) : opens_at_(threshold), closes_at_((1 - hysteresis) * threshold) {}
  static EffectInfo info();

 private:
  double output(double input, const StepTime&) override {
    is_open_ = input >= (is_open_ ? closes_at_ : opens_at_);
    return is_open_ ? input : 0;
  }
  /// A command that has been there for ever was reached from zero.
  double settled(double input) override {
    is_open_ = input >= opens_at_;
    return is_open_ ? input : 0;
  }

  double opens_at_, closes_at_;
  bool is_open_ = false;
};

}  // namespace musclesim
