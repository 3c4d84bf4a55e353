/// Force stage: the threads of the braid rub against each other and the bladder.
///
///     F' = F - (w ((1 - c) |F| + c p F_0) + F_c) z,    dz = (1 - z sgn(dz))^i |dl| / s,  dz > 0 while the muscle gets shorter
///
/// F tension in N, p pressure ratio, F_0 tension at full pressure and the force law's rest length in N, l length in mm, w = relative_width,
/// F_c = constant_friction_N, s = presliding_mm, c = pressure_share, i = presliding_exponent. The threads rub at any speed in the same way.
/// For i = 0 they slide all at once (one Maxwell slip element): z reaches +1 after the muscle has shortened by 2 s and -1 after it has
/// lengthened by 2 s. For i = 1 ever more of them slide (Dahl's model): z approaches +1 and -1 exponentially. For c = F_c = 0 the loop of
/// tension over length is 2 w F wide; for c = 1 its width depends on the pressure alone; for w = 0 it is always 2 F_c, as where a muscle
/// rubs in a sheath. Friction cannot push: F' >= 0 wherever F >= 0. At the start z = 0.
/// Neutral: w = 0 and F_c = 0. Range of w 0 .. 1, usually 0.01 .. 0.12; of F_c 0 .. 1000 N, usually 1 .. 20; of s 0.01 .. 50 mm, usually
/// 0.5 .. 3; of c and i 0 .. 1. Source: Maxwell slip, Iwan 1966; Dahl 1968; friction between threads in proportion to pressure, Tondu and
/// Lopez 2000; constant friction of a few N, Chou and Hannaford 1996.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class BraidHysteresis final : public ForceEffect {
 public:
  explicit BraidHysteresis(const EffectValues& values);
  static EffectInfo info();

  void attach(const EffectPlace& place) override;
  double tensionN(const MuscleInput& input, const ForceBelow& below) const override;
  void advance(const MuscleInput& input) override;
  void settle(const MuscleInput& input) override;

 private:
  double playAt(double length_mm) const;

  double width_, presliding_mm_, pressure_share_, exponent_, constant_N_;
  double full_tension_N_ = 0;                            ///< F_0
  double play_ = 0, length_mm_ = 0;                      ///< z, and the length for which it holds
  mutable double asked_length_mm_ = 0, asked_play_ = 0;  ///< the last answer of playAt: a step asks for it two or three times
};

}  // namespace musclesim
