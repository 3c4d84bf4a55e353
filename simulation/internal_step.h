/// Chooses the number of internal steps per control step and adapts the joints' parameters to the step's length.
#pragma once

#include <memory>
#include <vector>

#include "musclesim/robot/actuator.h"
#include "musclesim/robot/joint.h"
#include "musclesim/robot/physics.h"

namespace musclesim {

/// Number of internal steps per control step that keeps the muscles stable. For chains no internal step is longer than
///     margin * 2 / w,   w the fastest sway of neighbouring links (fastestSwayRadPerS).
/// 2 / w is the stability limit of an explicit force on beads without additional inertia; that inertia is a further safety. For line
/// muscles the bound is 0.6 h with h^2 K / 4 + h D / 2 = 1, where K and D are the largest rates of their stiffness and friction on the
/// bones. No internal step is longer than `physics.longest_internal_step_s`; without that bound the control step is the internal step.
int automaticSubsteps(double step_s, const PhysicsSettings& physics, const std::vector<std::unique_ptr<Joint>>& joints,
                      const std::vector<Actuator*>& actuators);

/// Sets the error reduction for a step of h_s on all joints whose error reduction is `before`, and the stiffness and damping of the chains'
/// stops.
void adaptJoints(double h_s, double before, const PhysicsSettings& physics, const std::vector<std::unique_ptr<Joint>>& joints,
                 const std::vector<Actuator*>& actuators);

}  // namespace musclesim
