/// Body stage: a muscle is attached at another place than in the model.
///     place' = place + d e + r v    for its start or its end, in the pose as built
/// d = offset_mm, r = rise_mm. e is the unit vector along the lever arm: perpendicular to the muscle's line in the pose as built, in the
/// plane of that line and the joint that the muscle spans, pointing away from the joint (rig: along x). v is the unit vector upward and
/// perpendicular to e. `attachment` selects the end. On elbow and wrist the start is in the world and the end is on the moving part, where
/// an offset changes the moment arm. The robot builds the muscle at place'; a robot that does not read the offset (Robot::mountedStart,
/// mountedEnd) refuses the effect, as rig and spring bench do for the end, whose offset would act like one of the start.
/// Neutral: d = r = 0. Range of both -200 .. 200 mm, usually -8 .. 8 for d and -3 .. 3 for r, because r changes the muscle's length
/// directly. Source: definition.
#pragma once

#include "musclesim/effect/effect_info.h"

namespace musclesim {

class AttachmentOffset final : public BodyEffect {
 public:
  static EffectInfo info();
  explicit AttachmentOffset(MuscleEnd end) : end_(end) {}

  void attach(const EffectPlace& place) override;

 private:
  MuscleEnd end_;
};

}  // namespace musclesim
