#include "joint_coulomb_friction.h"

#include "musclesim/units.h"

namespace musclesim {

EffectInfo JointCoulombFriction::info() {
  return {.id = "joint_coulomb_friction",
          .stage = Stage::body,
          .acts_on = {ComponentKind::joint},
          .summary = "dry friction in a joint",
          .equation = "torque = -tau_c sign(dq/dt), at rest within -tau_c .. tau_c    q joint angle, tau_c = torque_Nm",
          .signature = "loop width does not depend on pressure; sticks at reversal",
          .source = "Coulomb friction as a bounded force of constraint",
          .parameters = {{"torque_Nm", "N m", 0, 0, 100, 0.02, 1, "tau_c"}},
          .make = [](const EffectValues& values) { return std::make_unique<JointCoulombFriction>(values["torque_Nm"]); }};
}

void JointCoulombFriction::attach(const EffectPlace& place) {
  JointEffect::attach(place);
  const double before = dJointGetHingeParam(joint().id(), dParamFMax);
  dJointSetHingeParam(joint().id(), dParamVel, 0);
  const double largest = before + torque_Nm_ * mm_per_m * forcePerN();
  dJointSetHingeParam(joint().id(), dParamFMax, largest);
  // A softness (CFM) is a speed per torque: the joint creeps at this speed under the full torque.
  constexpr double creep_rad_per_s = 1e-6;
  dJointSetHingeParam(joint().id(), dParamCFM, creep_rad_per_s / largest);
}

}  // namespace musclesim
