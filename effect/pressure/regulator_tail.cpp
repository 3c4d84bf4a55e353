#include "regulator_tail.h"

#include <cmath>

namespace musclesim {

EffectInfo RegulatorTail::info() {
  return {.id = "regulator_tail",
          .stage = Stage::pressure,
          .acts_on = {ComponentKind::muscle},
          .summary = "the regulator makes the last part of a change slowly",
          .equation = "p = u - s (u - w), tau dw/dt = u - w    u requested, p delivered, w slow part, s = share, tau = time_constant_s",
          .signature = "after a fast change the measured pressure creeps on, in proportion to the change",
          .source = "relaxation of the pressure error; 2.5 % of a step between 0.5 and 4 s after it measured on a proportional valve",
          .parameters = {{"share", "", 0, 0, 0.5, 0.02, 0.2, "s, part of a change that comes late"},
                         {"time_constant_s", "s", 1, 0.01, 1000, 0.3, 3, "tau", true}},
          .make = [](const EffectValues& values) { return std::make_unique<RegulatorTail>(values["share"], values["time_constant_s"]); },
          .ignores_motion = true};
}

double RegulatorTail::output(double input, const StepTime& time) {
  slow_ = input + (slow_ - input) * std::exp(-time.h_s / time_constant_s_);
  return input - share_ * (input - slow_);
}

}  // namespace musclesim
