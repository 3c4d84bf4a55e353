/// Numbers of the robot's description that were taken as exact, but would do what a named effect does if they were a little off: a payload
/// may be a heavier hand, an attachment a longer lever.
#pragma once

#include <vector>

#include "../search/search.h"
#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// For every effect of the chosen explanation the numbers, nearest to their given values first, that can take its place on the fitted
/// recordings. Each is checked by simulation.
std::vector<NumberInstead> numbersInstead(const Search& search, int job_count, const OnSimulation& on_simulation);

}  // namespace musclesim
