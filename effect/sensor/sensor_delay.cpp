#include "sensor_delay.h"

namespace musclesim {

EffectInfo SensorDelay::info() {
  return {.id = "sensor_delay",
          .stage = Stage::sensor,
          .acts_on = {ComponentKind::signal},
          .summary = "a reading comes late",
          .equation = "y'(t) = y(t - T)    T = delay_s",
          .signature = "this signal late against all others",
          .source = "dead time of sampling, filters and buses",
          .parameters = {{"delay_s", "s", 0, 0, 2, 0.005, 0.1, "T"}},
          .make = [](const EffectValues& values) { return std::make_unique<SensorDelay>(values["delay_s"]); }};
}

double SensorDelay::reading(double value, const Moment& moment, long) {
  return history_.empty() ? value : history_.at(moment.clock_s - delay_s_);
}

void SensorDelay::track(double value, const Moment& moment) {
  history_.add(moment.clock_s, value);
  history_.forgetBefore(moment.clock_s - delay_s_);
}

}  // namespace musclesim
