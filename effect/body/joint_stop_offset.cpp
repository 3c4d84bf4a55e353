#include "joint_stop_offset.h"

#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"

namespace musclesim {

EffectInfo JointStopOffset::info() {
  return {.id = "joint_stop_offset",
          .stage = Stage::body,
          .acts_on = {ComponentKind::joint},
          .summary = "both stops of a joint are shifted, or give way like rubber",
          .equation =
              "low + d <= q <= high + d; if they give way, torque = 1 N m ((max(0, low + d - q) / g)^1.5 - (max(0, q - high - d) / g)^1.5)"
              "    q joint angle, d = offset_deg, g = give_deg",
          .signature = "the error appears only near the stops",
          .source = "definition; round elastic bodies, Hertz 1882",
          .parameters = {{"offset_deg", "deg", 0, -90, 90, -15, 15, "d"},
                         {"give_deg", "deg", 0, 0, 90, 0.2, 15, "g, how far a stop gives way under 1 N m; 0: hard"}},
          .make = [](const EffectValues& values) { return std::make_unique<JointStopOffset>(values["offset_deg"], values["give_deg"]); },
          .variants = Variants::stops};
}

void JointStopOffset::attach(const EffectPlace& place) {
  JointEffect::attach(place);
  const double low = dJointGetHingeParam(joint().id(), dParamLoStop), high = dJointGetHingeParam(joint().id(), dParamHiStop);
  if (std::isinf(low) || std::isinf(high)) throw BadParameter("joint_stop_offset on " + place.component + ": the joint has no stops");
  const double shift = offset_deg_ * rad_per_deg;
  if (give_deg_ == 0) return setHardStops(low + shift, high + shift);
  setHardStops(-dInfinity, dInfinity);
  low_deg_ = low * deg_per_rad + offset_deg_;
  high_deg_ = high * deg_per_rad + offset_deg_;
}

/// ODE ignores a low stop above the present high stop, so the low stop is set again after the high stop.
void JointStopOffset::setHardStops(double low_rad, double high_rad) const {
  dJointSetHingeParam(joint().id(), dParamLoStop, low_rad);
  dJointSetHingeParam(joint().id(), dParamHiStop, high_rad);
  dJointSetHingeParam(joint().id(), dParamLoStop, low_rad);
}

double JointStopOffset::pushNm(double depth_deg) const {
  return std::pow(std::max(0.0, depth_deg) / give_deg_, 1.5);
}

void JointStopOffset::apply(const StepTime&) {
  if (give_deg_ > 0) addTorqueNm(pushNm(low_deg_ - angleDeg()) - pushNm(angleDeg() - high_deg_));
}

}  // namespace musclesim
