/// The library's own effects.
#pragma once

#include <vector>

#include "musclesim/effect/catalogue.h"

namespace musclesim {

/// In the order in which they act within their stages.
std::vector<EffectInfo> builtInEffects();

/// Throws BadParameter for an entry that cannot be used; see registerEffect.
void requireUsable(const EffectInfo& info);

}  // namespace musclesim
