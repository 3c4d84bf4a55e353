#include "leak.h"

#include <algorithm>
#include <cmath>

namespace musclesim {

EffectInfo Leak::info() {
  return {
      .id = "leak",
      .stage = Stage::pressure,
      .acts_on = {ComponentKind::muscle},
      .summary = "a muscle loses air, and a valve of finite speed replaces it",
      .equation =
          "dp/dt = (u - p) / tau_r - k p^n    u delivered, p actual, k = leak_per_s, tau_r = regulator_time_constant_s, n = flow_exponent; "
          "with a valve lag on the muscle, k p^n is a term of that lag's equation",
      .signature = "pressure decays with a closed valve; with a regulator it stays below the command by a steady offset",
      .source = "mass balance; losses of 3 % to 80 % in 120 s measured with a closed valve",
      .parameters = {{"leak_per_s", "1/s", 0, 0, 100, 0.0003, 1, "k"},
                     {"regulator_time_constant_s", "s", 0.05, 1e-3, 5, 0.02, 0.15, "tau_r, where no valve lag acts on the muscle", true},
                     {"flow_exponent", "", 1, 0.3, 1.5, 0.5, 1,
                      "n; 1: laminar or choked flow, 0.5: turbulent flow through a hole at low pressure", true}},
      .make =
          [](const EffectValues& values) {
            return std::make_unique<Leak>(values["leak_per_s"], values["regulator_time_constant_s"], values["flow_exponent"]);
          },
      .ignores_motion = true,
      .variants = Variants::sizes};
}

AirRate Leak::ownRate(double pressure) const {
  constexpr double least_pressure = 1e-3;
  return {exponent_ == 1 ? leak_per_s_ : leak_per_s_ * std::pow(std::max(pressure, least_pressure), exponent_ - 1), 0};
}

double Leak::filled(double input, const StepTime& time) {
  return pressure_ = pressureAfter(time.h_s, pressure_, input, regulator_s_);
}

}  // namespace musclesim
