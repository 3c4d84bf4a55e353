/// What only one cause of a plant explains.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "numbers.h"
#include "truth.h"

namespace musclesim::blind {

/// The gap that remains, by signal, RMSE over noise, when the laws of the other causes, and the numbers that nobody measured within twice
/// their tolerances, stand in for the one that is left out as well as they can. They minimise the sum over signals of (RMSE / noise)^2 by
/// the method of Gauss and Newton from their true values on. `motion`: of the plant with all causes; `others`: laws of all causes but the
/// one. Whole numbers and parameters that only shape a law keep their values. NaN where the plant without the cause diverges.
std::map<std::string, double> contributionBeside(const std::vector<ActiveEffect>& others, const Truth::Motion& motion, const Truth& truth,
                                                 const NumberErrors& numbers);

}  // namespace musclesim::blind
