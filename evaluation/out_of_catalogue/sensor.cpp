/// Out-of-catalogue laws of the sensor stage: a bias that varies at random, a gain error that varies sinusoidally, a second-order filter
/// instead of a dead time, play with a weak centring spring, slower sampling instead of lost samples, a clock whose rate varies.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../effect/history.h"
#include "laws_by_stage.h"
#include "musclesim/robot/world.h"
#include "wander.h"

namespace musclesim::out_of_catalogue {

namespace {

/// y' = y + b (1 + 0.15 w(t)),  w varies at random
class WanderingBias final : public SensorEffect {
 public:
  explicit WanderingBias(const EffectValues& v) : offset_(v["offset"]) {}
  void attach(const EffectPlace& place) override { seed_ = place.world.seed() + static_cast<std::uint64_t>(place.signal); }
  double reading(double value, const StepTime& time, long) override {
    constexpr double share = 0.15, interval_s = 2;
    return value + offset_ * (1 + share * wander(seed_, time.clock_s, interval_s));
  }

 private:
  double offset_;
  std::uint64_t seed_ = 0;
};

/// y' = y + (g - 1) y (1 + 0.25 sin(2 pi y / y_0))
class WavyScale final : public SensorEffect {
 public:
  explicit WavyScale(const EffectValues& v) : gain_(v["gain"]), period_(v["period"]) {}
  double reading(double y, const StepTime&, long) override {
    constexpr double wave = 0.25;
    return y + (gain_ - 1) * y * (1 + wave * std::sin(2 * std::numbers::pi * y / period_));
  }

 private:
  double gain_, period_;
};

/// Two lags in series, each with half of the delay.
class Filter final : public SensorEffect {
 public:
  explicit Filter(const EffectValues& v) : tau_s_(v["delay_s"] / 2) {}
  void reset() override { begun_ = false; }
  double reading(double value, const StepTime&, long) override { return begun_ ? second_ : value; }
  void track(double value, const StepTime& time) override {
    if (!begun_) first_ = second_ = value;
    begun_ = true;
    const double kept = std::exp(-time.h_s / tau_s_);
    first_ = value + (first_ - value) * kept;
    second_ = first_ + (second_ - first_) * kept;
  }
  bool tracks() const override { return true; }

 private:
  double tau_s_, first_ = 0, second_ = 0;
  bool begun_ = false;
};

/// Play of width w in which the reading also creeps towards the middle with time constant T.
class CentredPlay final : public SensorEffect {
 public:
  explicit CentredPlay(const EffectValues& v) : width_(v["width"]), centring_s_(v["centring_s"]) {}
  void reset() override { begun_ = false; }
  double reading(double value, const StepTime&, long) override {
    return begun_ ? std::clamp(followed_, value - width_ / 2, value + width_ / 2) : value;
  }
  void track(double value, const StepTime& time) override {
    followed_ = reading(value, time, 0);
    followed_ = value + (followed_ - value) * std::exp(-time.h_s / centring_s_);
    begun_ = true;
  }
  bool tracks() const override { return true; }

 private:
  double width_, centring_s_, followed_ = 0;
  bool begun_ = false;
};

/// Takes only every n-th sample and holds it in between.
class SlowSampling final : public SensorEffect {
 public:
  explicit SlowSampling(const EffectValues& v) : every_(static_cast<long>(1 + std::lround(v["skipped_samples"]))) {}
  double reading(double value, const StepTime&, long sample) override {
    if (sample % every_ == 0) held_ = value;
    return held_;
  }
  bool perSample() const override { return true; }

 private:
  long every_;
  double held_ = 0;
};

/// y'(t) = y(t - r t (1 + 0.15 w(t))),  w varies at random
class UnsteadyClock final : public SensorEffect {
 public:
  explicit UnsteadyClock(const EffectValues& v) : lag_per_s_(v["lag_per_s"]) {}
  void attach(const EffectPlace& place) override { seed_ = place.world.seed() + static_cast<std::uint64_t>(place.signal); }
  void reset() override { history_.clear(); }
  double reading(double value, const StepTime& time, long) override {
    constexpr double share = 0.15, interval_s = 2;
    const double lag_s = lag_per_s_ * std::max(0.0, time.clock_s) * (1 + share * wander(seed_, time.clock_s, interval_s));
    return history_.empty() ? value : history_.at(time.clock_s - lag_s);
  }
  void track(double value, const StepTime& time) override { history_.add(time.clock_s, value); }
  bool tracks() const override { return true; }

 private:
  double lag_per_s_;
  std::uint64_t seed_ = 0;
  SampledHistory history_;
};

}  // namespace

std::vector<OutOfCatalogueLaw> sensorLaws() {
  const std::vector<ComponentKind> signal = {ComponentKind::signal};
  return {
      {entry("wandering_bias", Stage::sensor, signal, "y' = y + b (1 + 0.15 w(t))",
             {{"offset", "unit of the signal", 0, -1e4, 1e4, -5, 5, "b"}},
             [](const EffectValues& v) { return std::make_unique<WanderingBias>(v); }),
       "sensor_bias"},
      {entry("wavy_scale", Stage::sensor, signal, "y' = y + (g - 1) y (1 + 0.25 sin(2 pi y / y_0))",
             {{"gain", "", 1, -10, 10, 0.88, 1.12, "g"}, {"period", "unit of the signal", 100, 1e-3, 1e5, 50, 300, "y_0", true}},
             [](const EffectValues& v) { return std::make_unique<WavyScale>(v); }),
       "sensor_gain"},
      {entry("filter", Stage::sensor, signal, "two lags in a row, each with half of the delay",
             {{"delay_s", "s", 0, 0, 2, 0.01, 0.1, "of both"}}, [](const EffectValues& v) { return std::make_unique<Filter>(v); }),
       "sensor_delay"},
      {entry("centred_play", Stage::sensor, signal, "play of width w that is centred within T",
             {{"width", "unit of the signal", 0, 0, 1e3, 0.5, 5, "w"}, {"centring_s", "s", 3, 0.01, 1e3, 1, 10, "T", true}},
             [](const EffectValues& v) { return std::make_unique<CentredPlay>(v); }),
       "sensor_backlash"},
      {entry("slow_sampling", Stage::sensor, signal, "every (n + 1)-th sample is taken, held in between",
             {{"skipped_samples", "", 0, 0, 1e4, 1, 6, "n"}}, [](const EffectValues& v) { return std::make_unique<SlowSampling>(v); }),
       "sensor_dropout"},
      {entry("unsteady_clock", Stage::sensor, signal, "y'(t) = y(t - r t (1 + 0.15 w(t)))",
             {{"lag_per_s", "s/s", 0, 0, 0.5, 0.005, 0.05, "r"}}, [](const EffectValues& v) { return std::make_unique<UnsteadyClock>(v); }),
       "slow_clock"},
  };
}

}  // namespace musclesim::out_of_catalogue
