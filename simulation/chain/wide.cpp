#include "wide.h"

namespace musclesim::chain {

namespace {

constexpr int width = 8;

/// Eight numbers; loaded from and stored to any address. Inlined into the functions that are compiled for several processors.
using Wide = double __attribute__((vector_size(width * sizeof(double)), aligned(sizeof(double)), may_alias));

}  // namespace

MUSCLESIM_WIDE void subtractColumns(double* target, const double* const* columns, const double* factors, int group_count, int count) {
  int i = 0;
  for (; i + width <= count; i += width) {
    Wide sum = *reinterpret_cast<const Wide*>(target + i);
    for (int g = 0; g < group_count; ++g) {
      const double* const* c = columns + 4 * g;
      const double* f = factors + 4 * g;
      sum -= (f[0] * *reinterpret_cast<const Wide*>(c[0] + i) + f[1] * *reinterpret_cast<const Wide*>(c[1] + i)) +
             (f[2] * *reinterpret_cast<const Wide*>(c[2] + i) + f[3] * *reinterpret_cast<const Wide*>(c[3] + i));
    }
    *reinterpret_cast<Wide*>(target + i) = sum;
  }
  for (; i < count; ++i)
    for (int g = 0; g < group_count; ++g) {
      const double* const* c = columns + 4 * g;
      const double* f = factors + 4 * g;
      target[i] -= (f[0] * c[0][i] + f[1] * c[1][i]) + (f[2] * c[2][i] + f[3] * c[3][i]);
    }
}

MUSCLESIM_WIDE void combineSixRows(double* result, const double* const rows[6], const double factors[6], int count) {
  const double* f = factors;
  int i = 0;
  for (; i + width <= count; i += width) {
    Wide products[6];
    for (int row = 0; row < 6; ++row) products[row] = f[row] * *reinterpret_cast<const Wide*>(rows[row] + i);
    *reinterpret_cast<Wide*>(result + i) = (products[0] + products[1]) + (products[2] + products[3]) + (products[4] + products[5]);
  }
  for (; i < count; ++i)
    result[i] = (f[0] * rows[0][i] + f[1] * rows[1][i]) + (f[2] * rows[2][i] + f[3] * rows[3][i]) + (f[4] * rows[4][i] + f[5] * rows[5][i]);
}

}  // namespace musclesim::chain
