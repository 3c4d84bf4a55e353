/// Draws from a random stream.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "musclesim/base/random.h"

namespace musclesim::blind {

inline bool happens(RandomStream& random, double probability) {
  return random.uniform() < probability;
}

/// Log-uniform between two positive numbers.
inline double logUniform(RandomStream& random, double low, double high) {
  return low * std::pow(high / low, random.uniform());
}

/// One of 0 .. count - 1 with equal odds; count must not be 0.
inline std::size_t indexBelow(RandomStream& random, std::size_t count) {
  return std::min(static_cast<std::size_t>(random.uniform() * static_cast<double>(count)), count - 1);
}

/// One of several with equal odds; the list must not be empty.
template <class Item>
const Item& oneOf(RandomStream& random, const std::vector<Item>& items) {
  return items[indexBelow(random, items.size())];
}

/// Rounds to a whole multiple of 1 / per_unit.
inline double rounded(double value, double per_unit) {
  return std::round(value * per_unit) / per_unit;
}

}  // namespace musclesim::blind
