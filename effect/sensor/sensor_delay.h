/// Sensor stage: a reading comes late.
///     y'(t) = y(t - T)
/// T = delay_s. The signal is remembered at every internal step and joined by straight lines. Before the start of a run it is what it was
/// when the run began to settle.
/// Neutral: T = 0. Range 0 .. 2 s, usually 0.005 .. 0.1.  Source: dead time of sampling, filters and buses.
#pragma once

#include "../history.h"
#include "musclesim/effect/catalogue.h"

namespace musclesim {

class SensorDelay final : public SensorEffect {
 public:
  explicit SensorDelay(double delay_s) : delay_s_(delay_s) {}
  static EffectInfo info();

  void reset() override { history_.clear(); }
  double reading(double value, const Moment& moment, long sample) override;
  void track(double value, const Moment& moment) override;
  bool tracks() const override { return true; }

 private:
  double delay_s_;
  SampledHistory history_;
};

}  // namespace musclesim
