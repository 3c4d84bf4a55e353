/// The number of internal steps of a control step, and what of ODE's joints depends on their length.
#pragma once

#include <memory>
#include <vector>

#include "musclesim/robot/actuator.h"
#include "musclesim/robot/joint.h"
#include "musclesim/robot/physics.h"

namespace musclesim {

/// As many internal steps as the tension of the muscles asks for, none longer than
///     margin * 2 / w,   w the fastest sway of neighbouring links (Actuator::fastestSwayRadPerS)
/// for chains. 2 / w is the stability limit of an explicit force on the beads as they are, so the additional inertia is a safety beyond it.
/// For line muscles it is 0.6 h with h^2 K / 4 + h D / 2 = 1, K and D the largest rates of their springs and frictions on the bones.
/// Never longer than `physics.longest_internal_step_s`; in physics without that bound the control step is the internal step.
int automaticSubsteps(double step_s, const PhysicsSettings& physics, const std::vector<std::unique_ptr<Joint>>& joints,
                      const std::vector<Actuator*>& actuators);

/// Gives joints whose error reduction is `before` the one of this step, and the stops of chains their stiffness and damping.
void adaptJoints(double h_s, double before, const PhysicsSettings& physics, const std::vector<std::unique_ptr<Joint>>& joints,
                 const std::vector<Actuator*>& actuators);

}  // namespace musclesim
