/// Non-linear least squares with bounds.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace musclesim {

/// Minimise |r(x)|^2 over lowest <= x <= highest.
struct LeastSquaresProblem {
  /// Fills r(x). If it throws musclesim::Error, x counts as not allowed.
  std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& r)> residuals;
  int residual_count = 0;
  Eigen::VectorXd lowest, highest;
};

struct LeastSquaresResult {
  Eigen::VectorXd x;
  double sum_of_squares = 0;
  bool converged = false;
};

/// The best solution from several starts (Levenberg and Marquardt, by Ceres; derivatives by central differences). Deterministic.
/// Throws Error if no start leads to a solution.
LeastSquaresResult minimise(const LeastSquaresProblem& problem, const std::vector<Eigen::VectorXd>& starts);

/// dr/dx by central differences.
Eigen::MatrixXd jacobianOf(const LeastSquaresProblem& problem, const Eigen::VectorXd& x);

}  // namespace musclesim
