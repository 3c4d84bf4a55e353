/// Command stage: commands reach the valve late.
///     u'(t) = u(t - T)
/// u commanded, u' delivered pressure, fractions of full scale; T = delay_s. Over an internal step u' is the mean of u(t - T), so that the
/// motion depends smoothly on T. Before the start u is the first command.
/// Neutral: T = 0. Range 0 .. 2 s, usually 0.003 .. 0.1 s.  Source: pure dead time of tube and electronics; 44 to 96 ms measured on a
/// pneumatic muscle drive (see docs/reference/effects.md).
#pragma once

#include "../history.h"
#include "musclesim/effect/effect_info.h"

namespace musclesim {

class TransportDelay final : public MuscleRatioEffect {
 public:
  explicit TransportDelay(double delay_s) : delay_s_(delay_s) {}
  static EffectInfo info();

  void reset() override { history_.clear(); }

 private:
  double output(double input, const StepTime& time) override;
  double settled(double input) override;

  double delay_s_;
  HeldHistory history_;
};

}  // namespace musclesim
