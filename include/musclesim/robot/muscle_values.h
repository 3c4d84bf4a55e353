/// The values that travel through a step.
#pragma once

#include <vector>

namespace musclesim {

/// One entry per muscle of a world: the robot's muscles first, in the order of its action, then all others. Every step goes through the
/// columns from left to right: the controller sets the commands, the command and the pressure stage make pressures of them, the force stage
/// makes tensions of those, and the stepper hands the tensions to the bodies.
struct MuscleValues {
  std::vector<double> command_ratio;   ///< commanded pressure, fraction of full scale
  std::vector<double> pressure_ratio;  ///< pressure in the muscle, fraction of full scale
  std::vector<double> tension_N;       ///< pulling positive
};

}  // namespace musclesim
