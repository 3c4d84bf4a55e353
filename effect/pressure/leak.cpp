#include "leak.h"

#include <algorithm>
#include <cmath>

namespace musclesim {

EffectInfo Leak::info() {
  return {
      .id = "leak",
      .stage = Stage::pressure,
      .acts_on = {ComponentKind::muscle},
      .summary = "a muscle loses air, and a regulator of finite speed replaces it",
      .equation =
          "dp/dt = (u - p) / tau_r - k p^n    u delivered, p actual, k = leak_per_s, tau_r = regulator_time_constant_s, n = flow_exponent",
      .signature = "pressure decays with a closed valve; with a regulator it stays below the command by a steady offset",
      .source = "mass balance; losses of 3 % to 80 % in 120 s measured with a closed valve",
      .parameters = {{"leak_per_s", "1/s", 0, 0, 100, 0.0003, 1, "k"},
                     {"regulator_time_constant_s", "s", 0.05, 1e-3, 5, 0.02, 0.15, "tau_r", true},
                     {"flow_exponent", "", 1, 0.3, 1.5, 0.5, 1,
                      "n; 1: laminar or choked flow, 0.5: turbulent flow through a hole at low pressure", true}},
      .make =
          [](const EffectValues& values) {
            return std::make_unique<Leak>(values["leak_per_s"], values["regulator_time_constant_s"], values["flow_exponent"]);
          },
      .ignores_motion = true,
      .variants = Variants::sizes};
}

double Leak::lossPerS(double pressure) const {
  constexpr double least_pressure = 1e-3;
  return exponent_ == 1 ? leak_per_s_ : leak_per_s_ * std::pow(std::max(pressure, least_pressure), exponent_ - 1);
}

double Leak::output(double input, const StepTime& time) {
  const double loss_per_s = lossPerS(pressure_);
  const double held = input / (1 + loss_per_s * regulator_s_);
  return pressure_ = held + (pressure_ - held) * std::exp(-time.h_s * (1 / regulator_s_ + loss_per_s));
}

/// Solves p + tau_r k p^n = u by bisection; the left side grows with p.
double Leak::settled(double input) {
  constexpr int halvings = 50;
  double low = 0, high = input;
  for (int i = 0; i < halvings && exponent_ != 1; ++i) {
    const double middle = (low + high) / 2;
    (middle * (1 + lossPerS(middle) * regulator_s_) < input ? low : high) = middle;
  }
  return pressure_ = exponent_ == 1 ? input / (1 + leak_per_s_ * regulator_s_) : low;
}

}  // namespace musclesim
