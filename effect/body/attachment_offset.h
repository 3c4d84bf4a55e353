/// Body stage: a muscle starts beside the place where the model has it.
///     start' = start + d e + r v
/// d = offset_mm, r = rise_mm, v unit vector upward and perpendicular to e, e unit vector along the lever arm: perpendicular to the
/// muscle's line in the pose as built, in the plane of the line and the joint that the muscle spans, away from the joint (rig: along x).
/// The robot builds the muscle there; robots that do not ask for the offset (Robot::mountedStart) refuse the effect. Neutral: d = r = 0.
/// Range of both -200 .. 200 mm, usually -8 .. 8 and -3 .. 3: upward a muscle's length shows it at once.  Source: definition.
#pragma once

#include "musclesim/effect/catalogue.h"

namespace musclesim {

class AttachmentOffset final : public BodyEffect {
 public:
  static EffectInfo info();

  void attach(const EffectPlace& place) override;
};

}  // namespace musclesim
