/// Numbers of the robot's description that were taken as exact, but would do what a named effect does if they were a little off: a payload
/// may be a heavier hand, an attachment a longer lever.
#pragma once

#include <vector>

#include "../search/search.h"
#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// The numbers that can take the place of effects of the chosen explanation on the fitted recordings: those that replace several effects
/// first, then by effect, nearest to their given values first. Each is checked by simulation.
std::vector<NumberInstead> numbersInstead(const Search& search, const OnSimulation& on_simulation);

}  // namespace musclesim
