/// Two numbers side by side, one per chain of a pair: the unit in which chains are computed.
#pragma once

namespace musclesim::chain {

/// Arithmetic works lane by lane; a plain number acts on both lanes.
using Pack = double __attribute__((vector_size(16)));

inline constexpr int lane_count = 2;

inline Pack both(double value) {
  return Pack{value, value};
}

}  // namespace musclesim::chain
