#include "simd_kernels.h"

#include <algorithm>

namespace musclesim::chain {

namespace {

constexpr int width = tile_width;

/// Eight numbers that may be at any address. Functions that use it are inlined into the functions that are compiled for several processors.
/// Clang takes the alignment from a typedef, but not from `using`.
// NOLINTNEXTLINE(modernize-use-using)
typedef double Wide __attribute__((vector_size(width * sizeof(double)), aligned(sizeof(double)), may_alias));

[[gnu::always_inline]] inline double sumOf(const Wide& p) {
  return ((p[0] + p[1]) + (p[2] + p[3])) + ((p[4] + p[5]) + (p[6] + p[7]));
}

/// Forward substitution with six rows; the rows before `first` are not coupled.
template <int first>
[[gnu::always_inline]] inline void solveRowsFrom(Wide* rows, const double* l, const double* per_pivot) {
  for (int i = 0; i < first; ++i) rows[i] *= per_pivot[i];
  for (int i = first; i < 6; ++i) {
    Wide row = rows[i];
    for (int j = first; j < i; ++j) row -= l[6 * j + i] * rows[j];
    rows[i] = row * per_pivot[i];
  }
}

}  // namespace

void clear(double* numbers, int count) {
  std::fill_n(numbers, count, 0.0);
}

MUSCLESIM_SIMD void factoriseTile(double* a, double* per_pivots) {
  Wide* const columns = reinterpret_cast<Wide*>(a);
  for (int k = 0; k < tile_width; ++k) {
    const double per_pivot = per_pivots[k] = 1 / columns[k][k];
    const Wide l = columns[k] * per_pivot;
    for (int c = k + 1; c < tile_width; ++c) columns[c] -= columns[k][c] * l;
    columns[k] = l;
  }
}

MUSCLESIM_SIMD void solveTile(double* a, double* scaled, const double* l, const double* per_pivots) {
  Wide columns[tile_width];
  for (int k = 0; k < tile_width; ++k) {
    Wide column = reinterpret_cast<const Wide*>(a)[k];
    for (int m = 0; m < k; ++m) column -= l[m * tile_width + k] * columns[m];
    columns[k] = column;
  }
  for (int k = 0; k < tile_width; ++k) {
    reinterpret_cast<Wide*>(scaled)[k] = columns[k];
    reinterpret_cast<Wide*>(a)[k] = columns[k] * per_pivots[k];
  }
}

MUSCLESIM_SIMD void subtractTileProducts(double* const* targets, const double* left, const double* right, int count) {
  for (int i = 0; i < count; ++i) {
    Wide* const target = reinterpret_cast<Wide*>(targets[i]);
    const Wide* const columns = reinterpret_cast<const Wide*>(left + i * tile_size);
    Wide sum[tile_width];
    for (int c = 0; c < tile_width; ++c) sum[c] = target[c];
    for (int k = 0; k < tile_width; ++k) {
      const Wide column = columns[k];
      for (int c = 0; c < tile_width; ++c) sum[c] -= right[k * tile_width + c] * column;
    }
    for (int c = 0; c < tile_width; ++c) target[c] = sum[c];
  }
}

void solveLower(const double* l, double* x) {
  double y[width];
  std::copy_n(x, width, y);
#pragma GCC unroll 8
  for (int k = 0; k < width; ++k)
#pragma GCC unroll 8
    for (int i = k + 1; i < width; ++i) y[i] -= l[k * width + i] * y[k];
  std::copy_n(y, width, x);
}

void solveUpper(const double* l, double* x) {
  double y[width];
  std::copy_n(x, width, y);
#pragma GCC unroll 8
  for (int k = width - 1; k >= 0; --k)
#pragma GCC unroll 8
    for (int i = 0; i < k; ++i) y[i] -= l[i * width + k] * y[k];
  std::copy_n(y, width, x);
}

MUSCLESIM_SIMD void subtractProduct(double* y, const double* a, const double* x) {
  Wide sum = *reinterpret_cast<const Wide*>(y);
  for (int k = 0; k < tile_width; ++k) sum -= x[k] * reinterpret_cast<const Wide*>(a)[k];
  *reinterpret_cast<Wide*>(y) = sum;
}

MUSCLESIM_SIMD void subtractTransposed(double* y, const double* a, const double* x) {
  const Wide factors = *reinterpret_cast<const Wide*>(x);
  for (int k = 0; k < tile_width; ++k) {
    const Wide p = factors * reinterpret_cast<const Wide*>(a)[k];
    y[k] -= sumOf(p);
  }
}

MUSCLESIM_SIMD void solveSixRows(double y[6][width], const double* l, const double per_pivot[6], int first_coupled) {
  Wide* const rows = reinterpret_cast<Wide*>(y);
  if (first_coupled > 0)
    solveRowsFrom<3>(rows, l, per_pivot);
  else
    solveRowsFrom<0>(rows, l, per_pivot);
}

MUSCLESIM_SIMD void addTileProducts(double* tile, const double left[6][width], const double right[6][width], unsigned columns) {
  const Wide* const rows = reinterpret_cast<const Wide*>(left);
  for (; columns; columns &= columns - 1) {
    const int c = __builtin_ctz(columns);
    Wide products[6];
    for (int i = 0; i < 6; ++i) products[i] = right[i][c] * rows[i];
    reinterpret_cast<Wide*>(tile)[c] += (products[0] + products[1]) + (products[2] + products[3]) + (products[4] + products[5]);
  }
}

MUSCLESIM_SIMD void subtractCombination(double* x, const double y[6][width], const double factors[6]) {
  Wide sum = {};
  for (int i = 0; i < 6; ++i) sum += factors[i] * reinterpret_cast<const Wide*>(y)[i];
  *reinterpret_cast<Wide*>(x) -= sum;
}

MUSCLESIM_SIMD void addProduct(double sums[6], const double y[6][width], const double* x) {
  const Wide factors = *reinterpret_cast<const Wide*>(x);
  for (int i = 0; i < 6; ++i) {
    const Wide p = factors * reinterpret_cast<const Wide*>(y)[i];
    sums[i] += sumOf(p);
  }
}

}  // namespace musclesim::chain
