/// Four numbers side by side, one per chain of a bundle: the unit in which chains are computed.
#pragma once

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace musclesim::chain {

inline constexpr int lane_count = 4;

/// Arithmetic works lane by lane; a plain number acts on all lanes.
using Pack = double __attribute__((vector_size(lane_count * sizeof(double)), aligned(lane_count * sizeof(double))));

/// Packs are passed in different ways on different processors: functions that take or return one must become part of their callers.
#define MUSCLESIM_INLINE __attribute__((always_inline)) inline

MUSCLESIM_INLINE Pack all(double value) {
  return Pack{value, value, value, value};
}

/// Products of 6-vectors.
MUSCLESIM_INLINE Pack dot(const Pack a[6], const double b[6]) {
  Pack sum = a[0] * b[0];
  for (int i = 1; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

MUSCLESIM_INLINE Pack dot(const Pack a[6], const Pack b[6]) {
  Pack sum = a[0] * b[0];
  for (int i = 1; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace musclesim::chain
