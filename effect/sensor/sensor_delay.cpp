#include "sensor_delay.h"

#include <cmath>

namespace musclesim {

EffectInfo SensorDelay::info() {
  return {.id = "sensor_delay",
          .stage = Stage::sensor,
          .acts_on = {ComponentKind::signal},
          .summary = "a reading comes late",
          .equation = "y'(t) = f(t - (1 - c) T), c T df/dt = y - f    T = delay_s, c = filter_share",
          .signature = "this signal lags all others",
          .source = "dead time of sampling, filters and buses",
          .parameters = {{"delay_s", "s", 0, 0, 2, 0.005, 0.1, "T"},
                         {"filter_share", "", 0, 0, 1, 0, 1, "c, share of the delay that comes from a first-order filter", true, {}, true}},
          .make = [](const EffectValues& values) { return std::make_unique<SensorDelay>(values["delay_s"], values["filter_share"]); },
          .may_be_shared = true};
}

double SensorDelay::reading(double value, const StepTime& time, long) {
  return history_.empty() ? value : history_.at(time.clock_s - dead_time_s_);
}

void SensorDelay::track(double value, const StepTime& time) {
  const bool passes = history_.empty() || !(filter_s_ > 0);
  filtered_ = passes ? value : value + (filtered_ - value) * std::exp(-time.h_s / filter_s_);
  history_.add(time.clock_s, filtered_);
  history_.forgetBefore(time.clock_s - dead_time_s_);
}

}  // namespace musclesim
