/// Numbers of a model that nobody measured exactly: the plant's differ from the model's.
#pragma once

#include <map>
#include <string>

#include "musclesim/base/random.h"
#include "musclesim/log/recording.h"

namespace musclesim::blind {

/// The numbers of one plant and of the model that a diagnosis compares it with, by full name.
struct NumberErrors {
  double scale = 0;                                  ///< the drawn standard deviations over the robot's tolerances: 0 (no errors), 1 or 2
  std::map<std::string, double> tolerance, nominal;  ///< of all numbers with a tolerance
  std::map<std::string, double> truth;               ///< empty if there are no errors
};

/// Draws truth = nominal exp(scale s z) for each number with a tolerance s (Robot::parameterTolerances), z normal; a number stays within
/// its allowed range. 70 % of the plants have the scale 1; 10 % have 2, so that a diagnosis must be honest about more than it expects; 20 %
/// have no errors. `plan`: names robot and parameters of the model.
NumberErrors drawNumbers(const Recording& plan, RandomStream& random);

}  // namespace musclesim::blind
