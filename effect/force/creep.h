/// Force stage: the bladder gives way slowly.
///     F' = F(p, l - x),    tau dx/dt = amount (l - x - l_min) - x
/// F tension, l length, x creep in mm, l_min the muscle's shortest length, tau = time_constant_s. At constant tension l - x follows a step
/// in pressure or load at once and x with tau: the length at first reaches 1 / (1 + amount) of its final change. Exact for a length held
/// over the step. A run begins with creep complete. Neutral: amount = 0. Range 0 .. 10, usually 0.03 .. 0.25; of tau 1e-3 .. 1e4 s, usually
/// 0.3 .. 30.  Source: Kelvin-Voigt element in series; amounts of 0.07 to 0.19 with 0.53 to 1.0 s measured over 4 s.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class Creep final : public ForceEffect {
 public:
  Creep(double amount, double time_constant_s) : amount_(amount), tau_s_(time_constant_s) {}
  static EffectInfo info();

  double tensionN(const MuscleInput& input, const ForceBelow& below) const override;
  void advance(const MuscleInput& input) override;
  void settle(const MuscleInput& input) override { creep_mm_ = finalMm(input.length_mm); }

 private:
  /// Where x ends while the length is held.
  double finalMm(double length_mm) const;

  double amount_, tau_s_;
  double creep_mm_ = 0;  ///< x
};

}  // namespace musclesim
