#include "slow_clock.h"

namespace musclesim {

EffectInfo SlowClock::info() {
  return {.id = "slow_clock",
          .stage = Stage::sensor,
          .acts_on = {ComponentKind::signal},
          .summary = "a logger's clock runs slow, so that a reading falls ever further behind",
          .equation = "y'(t) = y((1 - r) t)    r = lag_per_s, t since the start of the run",
          .signature = "this signal's delay grows in proportion to the time",
          .source = "3.1 s per 100 s in a published record of a pneumatic wrist",
          .parameters = {{"lag_per_s", "s/s", 0, 0, 0.5, 0.002, 0.05, "r, what the reading falls behind by per second"}},
          .make = [](const EffectValues& values) { return std::make_unique<SlowClock>(values["lag_per_s"]); },
          .may_be_shared = true};
}

double SlowClock::reading(double value, const StepTime& time, long) {
  return history_.empty() ? value : history_.at(readTimeS(time.clock_s));
}

void SlowClock::track(double value, const StepTime& time) {
  history_.add(time.clock_s, value);
  history_.forgetBefore(readTimeS(time.clock_s));
}

}  // namespace musclesim
