/// An antagonistic wrist: two muscles turn a hand between two stops.
#pragma once

#include "musclesim/robot/robot.h"

namespace musclesim {

/// Hinge at the origin about +z; at angle 0 the hand points along +x and its weight turns it towards negative angles. Muscle 0 raises the
/// hand, muscle 1 lowers it. They run straight from the world at y = muscle_length to the two ends of a massless lever on the hand. At the
/// angle middle_deg the lever is perpendicular to the muscles; there their lengths are muscle_length and their moment arms are largest.
/// Both follow the force law of force_law.*, each with its own rest length.
/// Parameters: wrist.hand_kg 0.3, wrist.center_of_mass_mm 60, wrist.own_inertia_kgm2 0.0005 about the centre of mass,
/// wrist.muscle_length_mm 200, wrist.lever_mm 25, wrist.middle_deg 35, wrist.rest_length_0_mm 215, wrist.rest_length_1_mm 215,
/// wrist.minimum_length_mm 120, wrist.maximum_length_mm 400, wrist.low_stop_deg -2, wrist.high_stop_deg 90.
class Wrist : public Robot {
 public:
  explicit Wrist(World& world);
  std::string initialState() const override { return "settled"; }

 private:
  void buildHand();
  void buildMuscle(int i);

  double lever_mm_, middle_rad_;
  Primitive* hand_;
};

}  // namespace musclesim
