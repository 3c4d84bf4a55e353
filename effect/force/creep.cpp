#include "creep.h"

#include <cmath>

#include "musclesim/robot/actuator.h"

namespace musclesim {

EffectInfo Creep::info() {
  return {.id = "creep",
          .stage = Stage::force,
          .acts_on = {ComponentKind::muscle},
          .summary = "the bladder yields slowly under load",
          .equation = "F' = F(p, l - x), tau dx/dt = amount (l - x - l_max) - x    F tension, l length, x creep, tau = time_constant_s",
          .signature = "the length drifts while the measured pressure is constant",
          .source = "Kelvin-Voigt element in series; amounts of 0.07 to 0.19 with time constants of 0.53 to 1.0 s measured",
          .parameters = {{"amount", "", 0, 0, 10, 0.03, 0.25, "slow change of length over the immediate change"},
                         {"time_constant_s", "s", 1, 1e-3, 1e4, 0.3, 30, "tau", true}},
          .make = [](const EffectValues& values) { return std::make_unique<Creep>(values["amount"], values["time_constant_s"]); }};
}

double Creep::finalMm(double length_mm) const {
  return amount_ / (1 + amount_) * (length_mm - actuator().maximumLengthMm());
}

double Creep::tensionN(const MuscleInput& input, const ForceBelow& below) const {
  MuscleInput inside = input;
  inside.length_mm -= creep_mm_;
  inside.rate_mm_per_s -= (finalMm(input.length_mm) - creep_mm_) * (1 + amount_) / tau_s_;
  return below(inside);
}

void Creep::advance(const MuscleInput& input) {
  const double end_mm = finalMm(input.length_mm);
  creep_mm_ = end_mm + (creep_mm_ - end_mm) * std::exp(-input.time.h_s * (1 + amount_) / tau_s_);
}

}  // namespace musclesim
