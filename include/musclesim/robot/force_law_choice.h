/// Selects the force law of the muscles of a run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "musclesim/robot/force_law.h"

namespace musclesim {

/// Names of all laws, the values of "force_law.name"; the first is the default.
const std::vector<std::string>& forceLawNames();

/// Makes the law named by the parameter "force_law.name", with the constants "force_law.*", for a muscle with these lengths. The constants
/// of a measured muscle hold for relative lengths: a robot's muscle of length "force_law.rest_length_mm" corresponds to the measured muscle
/// at its rest length; 0 stands for each muscle's own maximum length. In Eq. 1 r = 0 at the muscle's own minimum length, or at
/// "force_law.minimum_length_ratio" times the rest length if that parameter is not 0.
std::unique_ptr<ForceLaw> makeForceLaw(Parameters& parameters, double minimum_length_mm, double maximum_length_mm);

}  // namespace musclesim
