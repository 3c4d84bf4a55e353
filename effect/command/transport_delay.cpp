#include "transport_delay.h"

namespace musclesim {

EffectInfo TransportDelay::info() {
  return {.id = "transport_delay",
          .stage = Stage::command,
          .acts_on = {ComponentKind::muscle},
          .summary = "commands reach the valve late",
          .equation = "u'(t) = u(t - T)    u commanded, u' delivered, T = delay_s",
          .signature = "phase lag in proportion to frequency, amplitude unchanged",
          .source = "dead time of tubes and electronics; 44 to 96 ms measured on a pneumatic muscle drive",
          .parameters = {{"delay_s", "s", 0, 0, 2, 0.003, 0.1, "dead time"}},
          .make = [](const EffectValues& values) { return std::make_unique<TransportDelay>(values["delay_s"]); },
          .ignores_motion = true};
}

double TransportDelay::output(double input, const StepTime& time) {
  history_.hold(time.clock_s, input);
  const double from_s = time.clock_s - delay_s_;
  const double result = time.h_s > 0 ? history_.mean(from_s, from_s + time.h_s) : history_.at(from_s);
  history_.forgetBefore(from_s);
  return result;
}

double TransportDelay::settled(double input) {
  history_.holdForEver(input);
  return input;
}

}  // namespace musclesim
