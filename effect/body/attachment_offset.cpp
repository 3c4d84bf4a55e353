#include "attachment_offset.h"

#include "musclesim/base/error.h"
#include "musclesim/robot/robot.h"

namespace musclesim {

namespace {

MuscleEnd endOf(const EffectValues& values) {
  return values["attachment"] == 0 ? MuscleEnd::start : MuscleEnd::end;
}

}  // namespace

EffectInfo AttachmentOffset::info() {
  return {.id = "attachment_offset",
          .stage = Stage::body,
          .acts_on = {ComponentKind::muscle},
          .summary = "a muscle is attached at another place than in the model",
          .equation =
              "place' = place + d e + r v    of its start or end; d = offset_mm, e along the lever arm, away from the joint, "
              "r = rise_mm, v upward",
          .signature = "length and moment arm of one muscle are wrong together, both depending on the angle",
          .source = "definition",
          .parameters = {{"offset_mm", "mm", 0, -200, 200, -8, 8, "d"},
                         {"rise_mm", "mm", 0, -200, 200, -3, 3, "r"},
                         {"attachment", "", 0, 0, 1, 0, 1, "the end of the muscle that is shifted", true, {"start", "end"}}},
          .make = [](const EffectValues& values) { return std::make_unique<AttachmentOffset>(endOf(values)); },
          .mount_offset_mm = [](const EffectValues& values, MuscleEnd end) -> Eigen::Vector2d {
            if (end != endOf(values)) return {0, 0};
            return {values["offset_mm"], values["rise_mm"]};
          },
          .variants = Variants::ends};
}

void AttachmentOffset::attach(const EffectPlace& place) {
  if (place.robot.asksForOffset(place.muscle, end_)) return;
  const bool start = end_ == MuscleEnd::start;
  throw BadParameter("attachment_offset on " + place.component + ": the robot " + place.robot.name() + " cannot shift the muscle's " +
                     (start ? "start" : "end") + "; it would have to build its muscles at " + (start ? "mountedStart()" : "mountedEnd()"));
}

}  // namespace musclesim
