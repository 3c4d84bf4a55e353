#include "intervals.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace musclesim {

Scatter scatterOf(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals) {
  // Scale the columns to length 1, so that units do not influence the rank.
  const Eigen::VectorXd scale = jacobian.colwise().norm().transpose().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = jacobian * scale.cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  constexpr double least_singular_ratio = 1e-6;  // difference quotients are accurate to about 1e-9
  const auto rank = static_cast<Eigen::Index>((svd.singularValues().array() > least_singular_ratio * svd.singularValues()(0)).count());
  const Eigen::MatrixXd u = svd.matrixU().leftCols(rank);
  const Eigen::MatrixXd inverse =
      scale.cwiseInverse().asDiagonal() * svd.matrixV().leftCols(rank) * svd.singularValues().head(rank).cwiseInverse().asDiagonal();
  constexpr double largest_leverage = 0.999;
  const Eigen::ArrayXd leverage = u.rowwise().squaredNorm().array().min(largest_leverage);
  return {inverse * u.transpose(), residuals.array().square() / (1 - leverage), svd.matrixV().rightCols(jacobian.cols() - rank)};
}

double degreesOfFreedom(const Eigen::VectorXd& weights, const Eigen::VectorXd& variances) {
  const Eigen::ArrayXd shares = weights.array().square() * variances.array();
  const double sum = shares.sum(), sum_of_squares = shares.square().sum();
  return sum_of_squares > 0 ? 3 * sum * sum / sum_of_squares - 2 : static_cast<double>(weights.size());
}

double student975(double degrees_of_freedom) {
  constexpr double z = 1.959963984540054, fewest = 4;
  const double n = std::max(degrees_of_freedom, fewest), z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) + (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

}  // namespace musclesim
