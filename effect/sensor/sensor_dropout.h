/// Sensor stage: samples are lost; the last value is held.
///     y'_k = y'_(k-1) during a dropout, y_k otherwise
/// fraction: share of the samples that are lost. Dropouts have a geometrically distributed length with mean mean_gap_samples. A sample is
/// one reading of the robot. The random numbers come from the run's seed and the signal's name; the first sample is never lost.
/// Neutral: fraction = 0. Range 0 .. 0.99, usually 0.01 .. 0.3.  Source: Gilbert 1960, two-state channel.
#pragma once

#include <optional>

#include "musclesim/base/random.h"
#include "musclesim/effect/effect_info.h"

namespace musclesim {

class SensorDropout final : public SensorEffect {
 public:
  SensorDropout(double fraction, double mean_gap_samples) : fraction_(fraction), mean_gap_samples_(mean_gap_samples) {}
  static EffectInfo info();

  void attach(const EffectPlace& place) override;
  void reset() override;
  double reading(double value, const StepTime&, long sample) override;
  bool perSample() const override { return true; }

 private:
  /// Draws whether the next sample is lost.
  bool drawGap();

  double fraction_, mean_gap_samples_;
  std::uint64_t seed_ = 0;
  std::string owner_;
  std::optional<RandomStream> random_;
  long sample_ = -1;
  bool in_gap_ = false;
  double held_ = 0, last_ = 0;
};

}  // namespace musclesim
