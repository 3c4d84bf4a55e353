/// Numbers of the robot's description that were taken as exact, but would do what a named effect does if they were a little off: a payload
/// may be a heavier hand, an attachment a longer lever.
#pragma once

#include <vector>

#include "../search/search.h"
#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// The numbers with which the chosen explanation does as well without one of its effects, or without several. Numbers that replace several
/// effects come first. The others follow in the order of the effects; of one effect, the number that changes least comes first. Every
/// number is checked by simulating the fitted recordings.
std::vector<NumberInstead> numbersInstead(const Search& search, const OnSimulation& on_simulation);

}  // namespace musclesim
