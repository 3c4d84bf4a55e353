/// The paper's RoboticArm: humerus, ulna, radius and hand, ribs and scapula, ten muscles (up to thirty).
#pragma once

#include "musclesim/robot/robot.h"

namespace musclesim {

/// Built from the table in robotic_arm_table.h. Signals: angle_elbow_deg, angle_wrist_deg, and as the hand the centre of mass of the
/// composite hand. Parameters: arm.muscle_count (1..30, default 10: number of muscles taken from the table, in its order),
/// arm.composite_inertia. Source: Braun 2007, Section 4; numbers of the published program.
class RoboticArm : public Robot {
 public:
  explicit RoboticArm(World& world);
};

}  // namespace musclesim
