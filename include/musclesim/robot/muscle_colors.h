/// The colours of a robot's muscles, shared by the screen and the plots.
#pragma once

#include <cstddef>
#include <vector>

#include "musclesim/color.h"

namespace musclesim {

class Robot;

/// The colours that a robot gave to its muscles; muscles without a name for their colour are left out.
std::vector<Color> namedMuscleColors(const Robot& robot);

/// The colour of a muscle: of those given or, for muscles beyond them, one that differs well from the others.
Color muscleColor(std::size_t muscle, const std::vector<Color>& given);

}  // namespace musclesim
