/// Force stage: the bladder yields slowly under load (creep).
///     F' = F(p, l - x),    x = sum x_i,    tau_i dx_i/dt = amount / n (l - x - l_0) - x_i
/// F tension, l length, x creep in mm, l_0 the force law's rest length. x is the strain of the bladder, so it is counted from the length of
/// the muscle at rest: that is the same in all runs of a machine, and no stop changes it.
/// With spread_decades = 0 there is one element, tau = time_constant_s: after a step in pressure or load l - x changes at once and x
/// follows with tau while the tension stays constant; the length first reaches 1 / (1 + amount) of its final change. Otherwise n = 4
/// elements share the amount; their time constants are in a geometric series about tau, with spread_decades from the shortest to the
/// longest.
/// Exact if the length is constant over the step. A run starts with creep complete.
/// Neutral: amount = 0. Range 0 .. 10, usually 0.03 .. 0.25; of tau 1e-3 .. 1e4 s, usually 0.3 .. 30; of spread_decades 0 .. 4, usually
/// 0 .. 2.  Source: Kelvin-Voigt elements in series; amounts of 0.07 to 0.19 with 0.53 to 1.0 s measured over 4 s, 1 to 300 s in a hold.
#pragma once

#include <vector>

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class Creep final : public ForceEffect {
 public:
  Creep(double amount, double time_constant_s, double spread_decades);
  static EffectInfo info();

  double tensionN(const MuscleInput& input, const ForceBelow& below) const override;
  void advance(const MuscleInput& input) override;
  void settle(const MuscleInput& input) override;

 private:
  /// A part of x that follows the length alone: dm/dt = rate (share (l - l_0) - m). Elements in series are coupled by x; their modes are
  /// not.
  struct Mode {
    double share, rate_per_s;
    double creep_mm = 0;  ///< m
  };
  double stretchMm(double length_mm) const;

  std::vector<Mode> modes_;
};

}  // namespace musclesim
