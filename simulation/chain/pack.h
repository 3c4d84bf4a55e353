/// Two numbers side by side, one per chain of a pair: the unit in which chains are computed.
#pragma once

namespace musclesim::chain {

/// Arithmetic works lane by lane; a plain number acts on both lanes.
using Pack = double __attribute__((vector_size(16)));

inline constexpr int lane_count = 2;

inline Pack both(double value) {
  return Pack{value, value};
}

/// Products of 6-vectors.
inline Pack dot(const Pack a[6], const double b[6]) {
  Pack sum = a[0] * b[0];
  for (int i = 1; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

inline Pack dot(const Pack a[6], const Pack b[6]) {
  Pack sum = a[0] * b[0];
  for (int i = 1; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace musclesim::chain
