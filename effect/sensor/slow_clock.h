/// Sensor stage: the clock of a logger runs slow, so that a reading falls ever further behind.
///     y'(t) = y((1 - r) t)    for t >= 0
/// r = lag_per_s: what the reading is behind by after t seconds is r t. t counts from the start of the run. The signal is stored at every
/// internal step and interpolated linearly. A clock that runs fast would read ahead, which a simulation cannot.
/// Neutral: r = 0. Range 0 .. 0.5, usually 0.002 .. 0.05.  Source: 3.1 s per 100 s in a published record of a pneumatic wrist, whose angles
/// were written by another clock than its commands.
#pragma once

#include "../history.h"
#include "musclesim/effect/effect_info.h"

namespace musclesim {

class SlowClock final : public SensorEffect {
 public:
  explicit SlowClock(double lag_per_s) : lag_per_s_(lag_per_s) {}
  static EffectInfo info();

  void reset() override { history_.clear(); }
  double reading(double value, const StepTime& time, long sample) override;
  void track(double value, const StepTime& time) override;
  bool tracks() const override { return true; }

 private:
  /// The time of which the clock reads at clock_s; before the run begins both are the same.
  double readTimeS(double clock_s) const { return clock_s > 0 ? (1 - lag_per_s_) * clock_s : clock_s; }

  double lag_per_s_;
  SampledHistory history_;
};

}  // namespace musclesim
