/// Body stage: dry friction in a joint.
///     torque = -tau_c sign(dq/dt); at rest, whatever keeps it at rest within -tau_c .. tau_c
/// q joint angle, tau_c = torque_Nm. It is a bound on a force of constraint in the stepper, so the joint sticks without creeping. It adds
/// to dry friction that the joint has already. Neutral: tau_c = 0. Range 0 .. 100 N m, usually 0.02 .. 1.  Source: Coulomb; motor with
/// bounded force of ODE.
#pragma once

#include "musclesim/effect/catalogue.h"

namespace musclesim {

class JointCoulombFriction final : public JointEffect {
 public:
  explicit JointCoulombFriction(double torque_Nm) : torque_Nm_(torque_Nm) {}
  static EffectInfo info();

  void attach(const EffectPlace& place) override;

 private:
  double torque_Nm_;
};

}  // namespace musclesim
