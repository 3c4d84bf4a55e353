/// Laws that the catalogue does not contain. They test the diagnosis on data that none of its hypotheses can reproduce exactly.
#pragma once

#include <vector>

#include "law.h"

namespace musclesim {

/// For every effect of the library a physically different law of the same cause, then laws whose cause the catalogue does not have.
const std::vector<OutOfCatalogueLaw>& outOfCatalogueLaws();

/// Registers all laws as unlisted effects: simulations accept them like any other effect, but the catalogue does not list them and no
/// diagnosis tests them. Further calls do nothing.
void registerOutOfCatalogueLaws();

}  // namespace musclesim
