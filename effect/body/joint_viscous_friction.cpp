#include "joint_viscous_friction.h"

namespace musclesim {

EffectInfo JointViscousFriction::info() {
  return {.id = "joint_viscous_friction",
          .stage = Stage::body,
          .acts_on = {ComponentKind::joint},
          .summary = "a joint resists in proportion to its speed",
          .equation = "torque = -b dq/dt    q joint angle in rad, b = damping_Nms_per_rad",
          .signature = "free swinging is damped; the width of the loop is proportional to speed",
          .source = "Armstrong-Helouvry, Dupont and Canudas de Wit 1994, viscous part of friction models",
          .parameters = {{"damping_Nms_per_rad", "N m s/rad", 0, 0, 10, 0.005, 0.5, "b"}},
          .make = [](const EffectValues& values) { return std::make_unique<JointViscousFriction>(values["damping_Nms_per_rad"]); }};
}

}  // namespace musclesim
