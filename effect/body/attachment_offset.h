/// Body stage: a muscle is attached beside the place where the model has it.
///     place' = place + d e + r v    of its start or its end, in the pose as built
/// d = offset_mm, r = rise_mm, v unit vector upward and perpendicular to e, e unit vector along the lever arm: perpendicular to the
/// muscle's line in the pose as built, in the plane of the line and the joint that the muscle spans, away from the joint (rig: along x).
/// attachment says which end; elbow, wrist: the start is in the world, the end on what moves, where an offset is a change of the moment
/// arm. The robot builds the muscle there; robots that do not ask for the offset (Robot::mountedStart, mountedEnd) refuse the effect: on
/// the rig and the spring bench the end would do what the start does. Neutral: d = r = 0. Range of both -200 .. 200 mm, usually -8 .. 8 and
/// -3 .. 3: upward a muscle's length shows it at once.  Source: definition.
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
