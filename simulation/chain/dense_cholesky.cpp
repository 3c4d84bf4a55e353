#include "dense_cholesky.h"

#include <algorithm>
#include <cmath>

namespace musclesim::chain {

namespace {

constexpr int panel_width = 4;

}  // namespace

void DenseCholesky::reset(int size) {
  size_ = size;
  stride_ = static_cast<std::size_t>((size + 1) / 2 * 2);
  const std::size_t needed = stride_ * static_cast<std::size_t>(size);
  if (entries_.size() < needed) entries_.resize(needed * 5 / 4);
  for (int j = 0; j < size; ++j) std::fill(column(j) + j, column(j) + size, 0.0);
}

void DenseCholesky::factorise() {
  for (int first = 0; first < size_; first += panel_width) {
    const int width = std::min(panel_width, size_ - first);
    factorPanel(first, width);
    if (width == panel_width) updateBehind(first, width);
  }
}

void DenseCholesky::factorPanel(int first, int width) {
  for (int j = first; j < first + width; ++j) {
    double* __restrict target = column(j);
    for (int k = first; k < j; ++k) {
      const double* __restrict earlier = column(k);
      const double factor = earlier[j];
      for (int i = j; i < size_; ++i) target[i] -= factor * earlier[i];
    }
    const double per_root = 1 / std::sqrt(target[j]);
    for (int i = j; i < size_; ++i) target[i] *= per_root;
  }
}

/// Subtracts the panel's four columns from all columns behind it.
void DenseCholesky::updateBehind(int first, int width) {
  const double* __restrict a = column(first);
  const double* __restrict b = column(first + 1);
  const double* __restrict c = column(first + 2);
  const double* __restrict d = column(first + 3);
  for (int j = first + width; j < size_; ++j) {
    double* __restrict target = column(j);
    const double fa = a[j], fb = b[j], fc = c[j], fd = d[j];
    for (int i = j; i < size_; ++i) target[i] -= (fa * a[i] + fb * b[i]) + (fc * c[i] + fd * d[i]);
  }
}

void DenseCholesky::solve(double* __restrict x) const {
  for (int j = 0; j < size_; ++j) {
    const double* __restrict l = column(j);
    x[j] /= l[j];
    const double factor = x[j];
    for (int i = j + 1; i < size_; ++i) x[i] -= factor * l[i];
  }
  for (int j = size_ - 1; j >= 0; --j) {
    const double* __restrict l = column(j);
    double sum[4] = {};
    int i = j + 1;
    for (; i + 3 < size_; i += 4)
      for (int lane = 0; lane < 4; ++lane) sum[lane] += l[i + lane] * x[i + lane];
    for (; i < size_; ++i) sum[0] += l[i] * x[i];
    x[j] = (x[j] - ((sum[0] + sum[1]) + (sum[2] + sum[3]))) / l[j];
  }
}

}  // namespace musclesim::chain
