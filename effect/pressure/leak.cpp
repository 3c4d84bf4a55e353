#include "leak.h"

#include <cmath>

namespace musclesim {

EffectInfo Leak::info() {
  return {
      .id = "leak",
      .stage = Stage::pressure,
      .acts_on = {ComponentKind::muscle},
      .summary = "a loss of air against a regulator of finite speed",
      .equation = "dp/dt = (u - p) / tau_r - k p    u delivered, p actual, k = leak_per_s, tau_r = regulator_time_constant_s",
      .signature = "decays while held, steady offset when regulated",
      .source = "mass balance; losses of 3 % to 80 % in 120 s measured with closed valve",
      .parameters = {{"leak_per_s", "1/s", 0, 0, 100, 0.0003, 0.05, "k"},
                     {"regulator_time_constant_s", "s", 0.05, 1e-3, 5, 0.02, 0.15, "tau_r", true}},
      .make = [](const EffectValues& values) { return std::make_unique<Leak>(values["leak_per_s"], values["regulator_time_constant_s"]); }};
}

double Leak::output(double input, const Moment& moment) {
  const double rate_per_s = 1 / regulator_s_ + leak_per_s_;
  const double held = input / (1 + leak_per_s_ * regulator_s_);
  return pressure_ = held + (pressure_ - held) * std::exp(-moment.h_s * rate_per_s);
}

double Leak::settled(double input) {
  return pressure_ = input / (1 + leak_per_s_ * regulator_s_);
}

}  // namespace musclesim
