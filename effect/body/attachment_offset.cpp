#include "attachment_offset.h"

#include "musclesim/error.h"
#include "musclesim/robot/robot.h"

namespace musclesim {

EffectInfo AttachmentOffset::info() {
  return {.id = "attachment_offset",
          .stage = Stage::body,
          .acts_on = {ComponentKind::muscle},
          .summary = "a muscle starts beside the place where the model has it",
          .equation = "start' = start + d e + r v    d = offset_mm, e along the lever arm, away from the joint, r = rise_mm, v upward",
          .signature = "torque and length errors of one muscle, tied together by the angle",
          .source = "definition",
          .parameters = {{"offset_mm", "mm", 0, -200, 200, -8, 8, "d"}, {"rise_mm", "mm", 0, -200, 200, -3, 3, "r"}},
          .make = [](const EffectValues&) { return std::make_unique<AttachmentOffset>(); },
          .start_offset_mm = [](const EffectValues& values) -> Eigen::Vector2d {
            return {values["offset_mm"], values["rise_mm"]};
          }};
}

void AttachmentOffset::attach(const EffectPlace& place) {
  if (!place.robot.asksForOffset(place.muscle))
    throw BadParameter("attachment_offset on " + place.component + ": the robot " + place.robot.name() +
                       " has no such offset; it would have to build its muscles at mountedStart()");
}

}  // namespace musclesim
