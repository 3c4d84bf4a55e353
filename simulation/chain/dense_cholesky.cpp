#include "dense_cholesky.h"

#include <algorithm>
#include <cmath>

#include "wide.h"

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

/// Panels of four columns, two at a time: the columns behind are read and written once for both.
void DenseCholesky::factorise() {
  for (int first = 0; first < size_; first += 2 * panel_width) {
    const int middle = std::min(first + panel_width, size_), last = std::min(first + 2 * panel_width, size_);
    factorPanel(first, middle - first);
    if (middle == last) return;
    update(first, panel_width, middle, last);
    factorPanel(middle, last - middle);
    if (last - middle == panel_width) update(first, 2 * panel_width, last, size_);
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

/// Subtracts the `width` columns from `first` on, four or eight, from the columns begin .. end - 1 behind them.
void DenseCholesky::update(int first, int width, int begin, int end) {
  const double* columns[2 * panel_width];
  double factors[2 * panel_width];
  for (int j = begin; j < end; ++j) {
    for (int k = 0; k < width; ++k) {
      columns[k] = column(first + k) + j;
      factors[k] = *columns[k];
    }
    subtractColumns(column(j) + j, columns, factors, width / panel_width, size_ - j);
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
