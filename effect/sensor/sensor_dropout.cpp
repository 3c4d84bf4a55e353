#include "sensor_dropout.h"

#include <algorithm>

#include "musclesim/robot/world.h"

namespace musclesim {

EffectInfo SensorDropout::info() {
  return {
      .id = "sensor_dropout",
      .stage = Stage::sensor,
      .acts_on = {ComponentKind::signal},
      .summary = "samples are lost; the reading holds the last value",
      .equation = "y'_k = y'_(k-1) for a share `fraction` of the samples, in dropouts of mean_gap_samples on average",
      .signature = "one signal has plateaus",
      .source = "Gilbert 1960, two-state channel",
      .parameters = {{"fraction", "", 0, 0, 0.99, 0.01, 0.3, "share of the samples that are lost"},
                     {"mean_gap_samples", "", 3, 1, 1e4, 1, 10, "mean number of lost samples in a row", true}},
      .make = [](const EffectValues& values) { return std::make_unique<SensorDropout>(values["fraction"], values["mean_gap_samples"]); },
      .may_be_shared = true};
}

void SensorDropout::attach(const EffectPlace& place) {
  seed_ = place.world.seed();
  owner_ = "sensor_dropout." + place.component;
  reset();
}

void SensorDropout::reset() {
  random_.emplace(seed_, owner_);
  sample_ = -1;
  in_gap_ = false;
}

bool SensorDropout::drawGap() {
  // In the long run a share f is lost if a dropout ends with probability 1/m and begins with probability f / (m (1 - f)).
  const double begin = std::min(1.0, fraction_ / (mean_gap_samples_ * (1 - fraction_)));
  return random_->uniform() < (in_gap_ ? 1 - 1 / mean_gap_samples_ : begin);
}

double SensorDropout::reading(double value, const StepTime&, long sample) {
  if (sample != sample_) {
    held_ = last_;
    in_gap_ = sample_ >= 0 && drawGap();
    sample_ = sample;
  }
  return last_ = in_gap_ ? held_ : value;
}

}  // namespace musclesim
