/// An antagonistic pair of muscles on one hinge.
#pragma once

#include "musclesim/robot/robot.h"

namespace musclesim {

/// Hinge at the origin about +z; at angle 0 the forearm hangs along -y, and a positive angle moves the hand towards +x. Muscle 0 (flexor)
/// at x = +35 mm and muscle 1 (extensor) at x = -35 mm run from the world at y = +240 mm to a massless crossbar on the forearm at y = -20
/// mm.
/// Parameters: elbow.forearm_kg 0.6, elbow.forearm_inertia_kgm2 0.0125 about the hinge, elbow.center_of_mass_mm 120,
/// elbow.minimum_length_mm 150, elbow.maximum_length_mm 320, elbow.stop_deg 70, elbow.hand_mm 250, elbow.lever_mm 35,
/// elbow.lower_attachment_mm -20, elbow.upper_attachment_mm 240.
class Elbow : public Robot {
 public:
  explicit Elbow(World& world);
  std::string initialState() const override { return "settled"; }
};

}  // namespace musclesim
