/// Whether recordings are in the units of their columns' names.
#pragma once

#include "plant.h"

namespace musclesim {

/// Throws BadFile if a signal is about a thousand times as large as in the model, or a thousandth of it: m instead of mm, kPa instead of
/// fractions.
void requireUnits(const Plant& plant, int recording, const Prediction& prediction);

}  // namespace musclesim
