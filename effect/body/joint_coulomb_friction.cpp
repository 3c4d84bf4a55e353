#include "joint_coulomb_friction.h"

#include "../presliding.h"
#include "musclesim/base/units.h"

namespace musclesim {

EffectInfo JointCoulombFriction::info() {
  return {
      .id = "joint_coulomb_friction",
      .stage = Stage::body,
      .acts_on = {ComponentKind::joint},
      .summary = "dry friction in a joint",
      .equation =
          "torque = -tau_c sign(dq/dt), at rest within -tau_c .. tau_c; with presliding d: -tau_c z, dz = (1 - z sgn(dq))^i dq / d    q "
          "joint angle, tau_c = torque_Nm, d = presliding_deg, i = presliding_exponent",
      .signature = "the width of the loop does not depend on pressure; the joint sticks at reversals",
      .source = "Coulomb friction as a bounded constraint force; Dahl 1968; Maxwell slip, Al-Bender, Lampaert and Swevers 2005",
      .parameters = {{"torque_Nm", "N m", 0, 0, 100, 0.02, 1, "tau_c"},
                     {"presliding_deg", "deg", 0, 0, 90, 0.1, 1, "d, angle over which friction acts like a spring before the joint slides",
                      true},
                     {"presliding_exponent", "", 0, 0, 1, 0, 1, "i; 0: the joint slides at once, 1: little by little", true}},
      .make = [](const EffectValues& v) {
        return std::make_unique<JointCoulombFriction>(v["torque_Nm"], v["presliding_deg"], v["presliding_exponent"]);
      }};
}

JointCoulombFriction::JointCoulombFriction(double torque_Nm, double presliding_deg, double presliding_exponent)
    : torque_Nm_(torque_Nm), presliding_rad_(presliding_deg * rad_per_deg), exponent_(presliding_exponent) {}

void JointCoulombFriction::attach(const EffectPlace& place) {
  JointEffect::attach(place);
  if (presliding_rad_ > 0) return;
  addDryFrictionNm(torque_Nm_);
}

void JointCoulombFriction::apply(const StepTime& time) {
  if (presliding_rad_ == 0 || !(time.h_s > 0)) return;  // friction does not shift an equilibrium
  share_ = slid(share_, time.h_s * rateRadPerS() / presliding_rad_, exponent_);
  addTorqueNm(-torque_Nm_ * share_);
}

}  // namespace musclesim
