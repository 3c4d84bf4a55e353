/// A hash that says whether the robots are still the same.
#pragma once

#include <string>

namespace musclesim {

/// Hash of all registered robots with their default parameters: names, masses and positions of the primitives, lengths and limits of the
/// muscles, parameters. It changes if a robot changes, so that a sweep cannot be continued with another model.
std::string robotsHash();

}  // namespace musclesim
