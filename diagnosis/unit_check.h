/// Whether recordings are in the units of their columns' names.
#pragma once

#include "plant.h"

namespace musclesim {

/// Throws BadFile if a signal's size is about a thousand times that of the model's or a thousandth of it: m in place of mm, kPa in
/// place of fractions.
void requireUnits(const Plant& plant, int recording, const Prediction& prediction);

}  // namespace musclesim
