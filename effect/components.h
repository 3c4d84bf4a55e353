/// Components of a robot by name, and the places that an effect takes on them.
#pragma once

#include <string>
#include <vector>

#include "musclesim/effect/catalogue.h"

namespace musclesim {

/// The places of an effect on a component; several for "all". Throws BadParameter if the robot has no such component or the effect does not
/// act on it.
std::vector<EffectPlace> placesFor(const EffectInfo& info, const std::string& component, World& world, Robot& robot);

/// "angle_elbow" of "angle_elbow_deg", "pressure_0" of itself.
std::string stemOf(const std::string& signal);

}  // namespace musclesim
