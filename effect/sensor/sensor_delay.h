/// Sensor stage: a reading comes late.
///     y'(t) = f(t - (1 - c) T),    c T df/dt = y - f
/// T = delay_s, c = filter_share: share of the delay that comes from a first-order filter; the rest is dead time. The signal is stored at
/// every internal step and interpolated linearly. Before the start of a run it has the value from which the run began to settle.
/// Neutral: T = 0. Range 0 .. 2 s, usually 0.005 .. 0.1; of c 0 .. 1.  Source: dead time of sampling, filters and buses.
#pragma once

#include "../history.h"
#include "musclesim/effect/effect_info.h"

namespace musclesim {

class SensorDelay final : public SensorEffect {
 public:
  SensorDelay(double delay_s, double filter_share) : dead_time_s_((1 - filter_share) * delay_s), filter_s_(filter_share * delay_s) {}
  static EffectInfo info();

  void reset() override { history_.clear(); }
  double reading(double value, const StepTime& time, long sample) override;
  void track(double value, const StepTime& time) override;
  bool tracks() const override { return true; }

 private:
  double dead_time_s_, filter_s_;
  double filtered_ = 0;
  SampledHistory history_;  ///< f, the filtered signal
};

}  // namespace musclesim
