/// Finds the parameters of an effect that matter on a component.
#pragma once

#include <string>
#include <vector>

#include "musclesim/effect/catalogue.h"

namespace musclesim {

/// Indices in info.parameters of the parameters that have an influence on `component`. Effects that act on angles and on lengths have
/// parameters for each (contact, sensor_backlash); all other parameters always count. A fit on that component may leave out parameters that
/// are not listed.
std::vector<std::size_t> relevantParameters(const EffectInfo& info, const std::string& component);

}  // namespace musclesim
