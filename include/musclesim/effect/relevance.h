/// Which parameters of an effect play a role on a component.
#pragma once

#include <string>
#include <vector>

#include "musclesim/effect/catalogue.h"

namespace musclesim {

/// Indices into info.parameters of those that change anything on a component. Effects on components of two kinds, angles and lengths, have
/// parameters for both (contact, sensor_backlash); all other parameters always count. What a fit on that component may leave out is not
/// in the list.
std::vector<std::size_t> relevantParameters(const EffectInfo& info, const std::string& component);

}  // namespace musclesim
