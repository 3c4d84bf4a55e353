/// Two or four numbers side by side, one per chain of a bundle: the unit in which chains are computed.
#pragma once

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace musclesim::chain {

/// Packs are passed in different ways on different processors: functions that take or return one must become part of their callers.
#define MUSCLESIM_INLINE __attribute__((always_inline)) inline

/// Arithmetic works lane by lane; a plain number acts on all lanes. The alignment is that of processors that have such registers.
template <int lanes>
struct PackOf;
template <>
struct PackOf<2> {
  using Type = double __attribute__((vector_size(16), aligned(16)));
};
template <>
struct PackOf<4> {
  using Type = double __attribute__((vector_size(32), aligned(32)));
};

template <int lanes>
using Pack = typename PackOf<lanes>::Type;

}  // namespace musclesim::chain
