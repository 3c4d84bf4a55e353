/// Laws that the catalogue does not contain. They test the diagnosis on data that its own hypotheses cannot have made.
#pragma once

#include <vector>

#include "law.h"

namespace musclesim {

/// For every effect of the library a physically different law of the same cause, then laws whose cause the catalogue does not have.
const std::vector<OutOfCatalogueLaw>& outOfCatalogueLaws();

/// Registers all of them as unlisted effects: simulations take them like any other, but the catalogue does not list them and no diagnosis
/// looks for them. Further calls do nothing.
void registerOutOfCatalogueLaws();

}  // namespace musclesim
