/// Laws that the catalogue does not contain. They test the diagnosis on data that none of its hypotheses can reproduce exactly.
#pragma once

#include <string>
#include <vector>

#include "musclesim/effect/effect_info.h"

namespace musclesim {

/// An effect whose id begins with "foreign.".
struct OutOfCatalogueLaw {
  EffectInfo info;
  std::string stands_for;  ///< id of the catalogue's effect with the same cause; empty if there is none
};

/// For every effect of the catalogue a physically different law of the same cause, then laws of causes that are not in the catalogue.
const std::vector<OutOfCatalogueLaw>& outOfCatalogueLaws();

/// Registers all laws as unlisted effects: simulations accept them like any other effect, but the catalogue does not list them and no
/// diagnosis tests them. Further calls do nothing.
void registerOutOfCatalogueLaws();

}  // namespace musclesim
