#include "joint_stiffness.h"

#include "musclesim/base/units.h"

namespace musclesim {

EffectInfo JointStiffness::info() {
  return {.id = "joint_stiffness",
          .stage = Stage::body,
          .acts_on = {ComponentKind::joint},
          .summary = "hoses and cables pull a joint to a rest angle",
          .equation = "torque = -k (q - q_0)    q joint angle in rad, k = stiffness_Nm_per_rad, q_0 = rest_deg",
          .signature = "restoring torque error in proportion to the angle",
          .source = "linear spring",
          .parameters = {{"stiffness_Nm_per_rad", "N m/rad", 0, 0, 1000, 0.05, 2, "k"},
                         {"rest_deg", "deg", 0, -180, 180, -30, 30, "q_0", true}},
          .make = [](const EffectValues& values) {
            return std::make_unique<JointStiffness>(values["stiffness_Nm_per_rad"], values["rest_deg"]);
          }};
}

void JointStiffness::apply(const StepTime&) {
  addTorqueNm(-stiffness_ * (angleDeg() - rest_deg_) * rad_per_deg);
}

}  // namespace musclesim
