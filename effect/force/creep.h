/// Force stage: the bladder yields slowly under load (creep).
///     F' = F(p, l - x),    tau dx/dt = amount (l - x - l_max) - x
/// F tension, l length, x creep in mm, l_max the muscle's longest length, tau = time_constant_s. After a step in pressure or load l - x
/// changes at once and x follows with tau while the tension stays constant: the length first reaches 1 / (1 + amount) of its final change.
/// Exact if the length is constant over the step. A run starts with creep complete.
/// Neutral: amount = 0. Range 0 .. 10, usually 0.03 .. 0.25; of tau 1e-3 .. 1e4 s, usually 0.3 .. 30.  Source: Kelvin-Voigt element in
/// series; amounts of 0.07 to 0.19 with 0.53 to 1.0 s measured over 4 s.
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
  /// Final value of x if the length stays constant.
  double finalMm(double length_mm) const;

  double amount_, tau_s_;
  double creep_mm_ = 0;  ///< x
};

}  // namespace musclesim
