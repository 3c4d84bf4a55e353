/// Predictions near one explanation, linear in everything that may change: whole sets of causes can be compared without simulating them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "comparison.h"

namespace musclesim {

/// Minimises x^T N x / 2 - s^T x between bounds by coordinate descent (N positive definite), from x on, until no coordinate moves by
/// `still`.
void descend(const Eigen::MatrixXd& normal, const Eigen::VectorXd& slope, const Eigen::VectorXd& least, const Eigen::VectorXd& most,
             double still, Eigen::VectorXd& x);

class LinearModel {
 public:
  /// A change of the prediction per unit of an amount, and what the amount may be.
  struct Column {
    SharedVector change;
    double least, most;
    double precision;  ///< of a normal prior of start + amount about 0
    double start = 0;
  };
  struct Solution {
    double cost;  ///< misfit + sum of precision (start + amount)^2 / 2, in nats
    Eigen::VectorXd amounts;
  };

  /// `residual`: measured minus predicted where all amounts are 0.
  LinearModel(const Comparison& comparison, const Eigen::VectorXd& residual, std::vector<Column> columns);
  /// The amounts of some columns that cost least, the others being 0: reweighted bounded least squares. Needs the squares of sums within
  /// each residual block only (its Gram matrix), so that it takes microseconds.
  Solution solve(const std::vector<std::size_t>& columns) const;

 private:
  struct Normal {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd slope;
  };
  Normal normalOf(const std::vector<std::size_t>& columns, const std::vector<double>& weights) const;

  const Comparison& comparison_;
  std::vector<Column> columns_;
  std::vector<Eigen::MatrixXd> grams_;  ///< per block: mean products of all columns and, last, the residual
};

}  // namespace musclesim
