/// Body stage: dry friction between a body and the guide on which it slides, as of a load that runs on a rail.
///     force = -F_c sign(dx/dt); at rest, the force within -F_c .. F_c that keeps it at rest
/// x position on the guide, F_c = force_N. The stepper treats it as a bounded constraint force, so the body sticks without creeping. It
/// adds to the guide's existing dry friction. With presliding_mm = d > 0 the friction acts like a spring before the body slides:
///     force = -F_c z,    dz = (1 - z sgn(dx))^i dx / d
/// i = presliding_exponent, as in joint_coulomb_friction.
/// Neutral: F_c = 0. Range 0 .. 1e4 N, usually 0.5 .. 10; d 0 .. 100 mm, usually 0.05 .. 1; i 0 .. 1.  Source: Coulomb; ODE's motor with
/// bounded force; Dahl 1968; Al-Bender, Lampaert and Swevers 2005.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class SlideFriction final : public SlideEffect {
 public:
  SlideFriction(double force_N, double presliding_mm, double presliding_exponent)
      : force_N_(force_N), presliding_mm_(presliding_mm), exponent_(presliding_exponent) {}
  static EffectInfo info();

  void attach(const EffectPlace& place) override;
  void reset() override { share_ = 0; }
  void apply(const StepTime& time) override;

 private:
  double force_N_, presliding_mm_, exponent_;
  double share_ = 0;  ///< z
};

}  // namespace musclesim
