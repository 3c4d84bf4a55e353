/// Finds the places on a robot where an effect acts, from a component's name.
#pragma once

#include <string>
#include <vector>

#include "musclesim/effect/catalogue.h"

namespace musclesim {

/// The places where an effect acts on a component; several for "all". Throws BadParameter if the robot has no such component or the effect
/// cannot act on it.
std::vector<EffectPlace> placesFor(const EffectInfo& info, const std::string& component, World& world, Robot& robot);

/// The signal's name without its unit: "angle_elbow" for "angle_elbow_deg", "pressure_0" for "pressure_0".
std::string stemOf(const std::string& signal);

}  // namespace musclesim
