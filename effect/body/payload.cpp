#include "payload.h"

#include "musclesim/base/units.h"
#include "musclesim/robot/robot.h"

namespace musclesim {

EffectInfo Payload::info() {
  return {.id = "payload",
          .stage = Stage::body,
          .acts_on = {ComponentKind::hand},
          .summary = "the hand carries a mass that is not in the model",
          .equation = "m' = m + mass_kg, with the inertia of a point mass at the hand",
          .signature = "torque error with a gravity part and a part in proportion to acceleration",
          .source = "parallel-axis theorem",
          .parameters = {{"mass_kg", "kg", 0, -1000, 1000, -0.3, 1, "mass in the hand; rig: on the load"}},
          .make = [](const EffectValues& values) { return std::make_unique<Payload>(values["mass_kg"]); }};
}

void Payload::attach(const EffectPlace& place) {
  HandEffect::attach(place);
  place.robot.loadHand(mass_kg_ * g_per_kg);
}

}  // namespace musclesim
