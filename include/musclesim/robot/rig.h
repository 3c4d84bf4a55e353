/// The load frame of the paper's experiment: one hanging muscle carries a load.
#pragma once

#include "musclesim/robot/robot.h"

namespace musclesim {

/// One muscle hangs from the origin along -y; a ball joint at its lower end carries the load, a point-like mass on a frictionless vertical
/// slider. Parameters: rig.minimum_length_mm 120, rig.maximum_length_mm 300, rig.load_kg 2.  Source: Braun 2007, Section 3.2.
class Rig : public Robot {
 public:
  explicit Rig(World& world);
  /// Places the load at the frictionless equilibrium F(p, l) = (load + chain/2) g with l between the stops, including all effects.
  void settle() override;
  std::string initialState() const override { return "settled"; }

 private:
  Vector top_mm_;
  Actuator* muscle_;
  Primitive* load_;
};

}  // namespace musclesim
