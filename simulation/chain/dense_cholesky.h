/// Dense symmetric positive definite systems of some ten to some hundred rows.
#pragma once

#include <vector>

namespace musclesim::chain {

/// A = L L^T in place; only the lower part of A is used. Columns are contiguous.
class DenseCholesky {
 public:
  /// Sets the size and all entries to 0.
  void reset(int size);
  int size() const { return size_; }
  double& at(int row, int column) { return entries_[static_cast<std::size_t>(column) * stride_ + static_cast<std::size_t>(row)]; }
  double at(int row, int column) const { return entries_[static_cast<std::size_t>(column) * stride_ + static_cast<std::size_t>(row)]; }
  /// Adds to the entry and its mirror image, which are one here.
  void add(int row, int column, double value) { row >= column ? at(row, column) += value : at(column, row) += value; }

  void factorise();
  /// x <- A^-1 x, after factorise().
  void solve(double* x) const;

 private:
  void factorPanel(int first, int width);
  void update(int first, int width, int begin, int end);
  double* column(int j) { return entries_.data() + static_cast<std::size_t>(j) * stride_; }
  const double* column(int j) const { return entries_.data() + static_cast<std::size_t>(j) * stride_; }

  int size_ = 0;
  std::size_t stride_ = 0;
  std::vector<double> entries_;
};

}  // namespace musclesim::chain
