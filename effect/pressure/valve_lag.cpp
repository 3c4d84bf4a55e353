#include "valve_lag.h"

#include <cmath>

namespace musclesim {

EffectInfo ValveLag::info() {
  return {.id = "valve_lag",
          .stage = Stage::pressure,
          .acts_on = {ComponentKind::muscle},
          .summary = "the valve fills and vents the muscle with a lag",
          .equation = "dp/dt = (u - p) / tau    u delivered, p actual; tau by the sign of u - p",
          .signature = "roll-off that scales with amplitude; gone when measured pressure is fed in",
          .source = "first-order lag of valve and volume; 0.05 and 0.084 s, 0.126 and 0.089 s measured",
          .parameters = {{"fill_time_constant_s", "s", 0, 0, 5, 0.01, 0.2, "tau while u > p"},
                         {"vent_time_constant_s", "s", 0, 0, 5, 0.01, 0.2, "tau otherwise"}},
          .make = [](const EffectValues& values) {
            return std::make_unique<ValveLag>(values["fill_time_constant_s"], values["vent_time_constant_s"]);
          }};
}

double ValveLag::output(double input, const Moment& moment) {
  const double tau_s = input > pressure_ ? fill_s_ : vent_s_;
  pressure_ = tau_s > 0 ? input + (pressure_ - input) * std::exp(-moment.h_s / tau_s) : input;
  return pressure_;
}

}  // namespace musclesim
