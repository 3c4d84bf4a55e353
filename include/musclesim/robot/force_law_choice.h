/// Which force law the muscles of a run follow.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "musclesim/robot/force_law.h"

namespace musclesim {

/// Names of all laws, as "force_law.name" takes them; the first is the default.
const std::vector<std::string>& forceLawNames();

/// The law that the parameter "force_law.name" asks for, for a muscle with these lengths, with the constants of "force_law.*".
/// The constants of a measured muscle hold for relative lengths: "force_law.rest_length_mm" is the length at which the robot's muscles
/// correspond to the measured muscle at its rest length; 0 stands for each muscle's own maximum length. Eq. 1 takes r = 0 at the muscle's
/// own minimum length unless "force_law.minimum_length_ratio" gives another, as a fraction of the rest length.
std::unique_ptr<ForceLaw> makeForceLaw(Parameters& parameters, double minimum_length_mm, double maximum_length_mm);

}  // namespace musclesim
