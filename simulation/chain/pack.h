/// SIMD vector of two or four numbers, one per chain of a bundle.
#pragma once

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace musclesim::chain {

/// Processors pass packs to functions in different ways, so functions that take or return a pack must be inlined.
#define MUSCLESIM_INLINE __attribute__((always_inline)) inline

/// Arithmetic works lane by lane; a plain number acts on all lanes. The alignment is the one of SIMD registers of this size.
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
