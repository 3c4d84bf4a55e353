#include "joint_stop_offset.h"

#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"

namespace musclesim {

EffectInfo JointStopOffset::info() {
  return {.id = "joint_stop_offset",
          .stage = Stage::body,
          .acts_on = {ComponentKind::joint},
          .summary = "both stops of a joint are shifted",
          .equation = "low + d <= q <= high + d    q joint angle, d = offset_deg",
          .signature = "the error appears only near the stops",
          .source = "definition",
          .parameters = {{"offset_deg", "deg", 0, -90, 90, -15, 15, "d"}},
          .make = [](const EffectValues& values) { return std::make_unique<JointStopOffset>(values["offset_deg"]); }};
}

void JointStopOffset::attach(const EffectPlace& place) {
  JointEffect::attach(place);
  const double low = dJointGetHingeParam(joint().id(), dParamLoStop), high = dJointGetHingeParam(joint().id(), dParamHiStop);
  if (std::isinf(low) || std::isinf(high)) throw BadParameter("joint_stop_offset on " + place.component + ": the joint has no stops");
  const double shift = offset_deg_ * rad_per_deg;
  // ODE ignores a low stop above the present high stop, so the low stop is set again after the high stop.
  dJointSetHingeParam(joint().id(), dParamLoStop, low + shift);
  dJointSetHingeParam(joint().id(), dParamHiStop, high + shift);
  dJointSetHingeParam(joint().id(), dParamLoStop, low + shift);
}

}  // namespace musclesim
