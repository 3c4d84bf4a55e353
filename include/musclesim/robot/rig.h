/// The load frame of the paper's experiment: one hanging muscle carries a load.
#pragma once

#include "musclesim/robot/robot.h"

namespace musclesim {

/// One muscle hangs from the origin along -y; a ball joint at its lower end carries the load, a point-like mass on a frictionless vertical
/// slider. Settled: F(p, l) = (load + chain/2) g, without effects and with l between the stops.
/// Parameters: rig.minimum_length_mm 120, rig.maximum_length_mm 300, rig.load_kg 2.  Source: Braun 2007, Section 3.2.
class Rig : public Robot {
 public:
  explicit Rig(World& world);
  std::string initialState() const override { return "settled"; }
};

}  // namespace musclesim
