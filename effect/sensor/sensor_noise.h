/// Sensor stage: white noise on a reading. It is a property of the sensor, not an effect of the catalogue.
///     y' = y + sigma n_k
/// sigma standard deviation in the unit of the signal, n_k standard normal, one per sample, drawn from the run's seed and the signal's
/// name.
#pragma once

#include <optional>

#include "musclesim/base/random.h"
#include "musclesim/effect/effect.h"

namespace musclesim {

class SensorNoise final : public SensorEffect {
 public:
  SensorNoise(double deviation, std::uint64_t seed, const std::string& signal) : deviation_(deviation), seed_(seed), signal_(signal) {
    reset();
  }

  void reset() override {
    random_.emplace(seed_, "sensor_noise." + signal_);
    sample_ = -1;
  }
  double reading(double value, const StepTime&, long sample) override {
    if (sample != sample_) noise_ = deviation_ * random_->normal();
    sample_ = sample;
    return value + noise_;
  }
  bool perSample() const override { return true; }

 private:
  double deviation_;
  std::uint64_t seed_;
  std::string signal_;
  std::optional<RandomStream> random_;
  long sample_ = -1;
  double noise_ = 0;
};

}  // namespace musclesim
