/// Readings in which a joint is at its stop, or was just before.
#pragma once

#include <string>
#include <vector>

#include "musclesim/log/recording.h"
#include "musclesim/robot/robot.h"

namespace musclesim {

/// Removes the readings of motion and force from each contact of a joint with a stop to forgotten_after_s after it. How an arm leaves a
/// stop depends on the impact so delicately that a model with slightly wrong numbers is far off there, and fits end in wrong minima.
/// Contacts are seen in measured angles only, within 1 deg of a stop. Everything stays
/// - if a joint is measured beyond its stop: then that is elsewhere, which is a cause to be found,
/// - if less than half of all rows would be left: then resting on stops is what the machine does.
/// Returns notes: where this happened, and what became of it. `recordings` are of `robot`.
std::vector<std::string> dropAfterStops(std::vector<Recording>& recordings, const Robot& robot);

}  // namespace musclesim
