/// A smooth random signal for laws that drift.
#pragma once

#include <cstdint>

namespace musclesim::out_of_catalogue {

/// A number between -1 and 1 that changes smoothly and at random: straight lines between values drawn every `interval_s`.
double wander(std::uint64_t seed, double time_s, double interval_s);

}  // namespace musclesim::out_of_catalogue
