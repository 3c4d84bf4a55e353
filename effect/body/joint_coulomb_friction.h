/// Body stage: dry friction in a joint.
///     torque = -tau_c sign(dq/dt); at rest, the torque within -tau_c .. tau_c that keeps it at rest
/// q joint angle, tau_c = torque_Nm. The stepper treats it as a bounded constraint force, so the joint sticks without creeping. It adds to
/// the joint's existing dry friction; damping of the joint (robot files) is a force beside it. With presliding_deg = d > 0 the friction
/// acts like a spring before the joint slides:
///     torque = -tau_c z,    dz = (1 - z sgn(dq))^i dq / d
/// i = presliding_exponent. For i = 0 the joint slides at once (one Maxwell slip element), for i = 1 little by little (Dahl's model).
/// Neutral: tau_c = 0. Range 0 .. 100 N m, usually 0.02 .. 1; d 0 .. 90 deg, usually 0.1 .. 1; i 0 .. 1.  Source: Coulomb; ODE's motor with
/// bounded force; Dahl 1968; Al-Bender, Lampaert and Swevers 2005.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class JointCoulombFriction final : public JointEffect {
 public:
  JointCoulombFriction(double torque_Nm, double presliding_deg, double presliding_exponent);
  static EffectInfo info();

  void attach(const EffectPlace& place) override;
  void reset() override { share_ = 0; }
  void apply(const StepTime& time) override;

 private:
  double torque_Nm_, presliding_rad_, exponent_;
  double share_ = 0;  ///< z
};

}  // namespace musclesim
