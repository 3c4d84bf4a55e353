/// Laws that the catalogue does not contain, for checks of a diagnosis: it must not be tested on data that its own candidates made.
#pragma once

#include <string>
#include <vector>

#include "musclesim/effect/catalogue.h"

namespace musclesim {

/// An effect with an id that begins with "foreign.". Simulations take it like any other, the catalogue does not list it.
struct ForeignEffect {
  EffectInfo info;
  std::string stands_for;  ///< the catalogue's id of the same cause; empty: no effect of the catalogue has this cause
};

/// For every effect of the library a physically different law of the same cause, then effects that the catalogue has no cause for.
const std::vector<ForeignEffect>& foreignEffects();

}  // namespace musclesim
