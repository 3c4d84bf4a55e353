#include "fit_problem.h"

#include <algorithm>
#include <cmath>

#include "../../base/parallel.h"

namespace musclesim {

Eigen::VectorXd movedBy(Eigen::VectorXd z, Eigen::Index coordinate, double difference) {
  z[coordinate] += difference * std::max(1.0, std::abs(z[coordinate]));
  return z;
}

double priorCost(const FitProblem& problem, const Eigen::VectorXd& z) {
  return problem.precision.size() ? 0.5 * z.cwiseAbs2().dot(problem.precision) : 0;
}

FitPoint evaluate(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& z) {
  FitPoint point{problem.clamped(z), {}};
  const Eigen::VectorXd predicted = problem.predicted(point.z);
  if (predicted.size() != comparison.size() || !predicted.allFinite()) return point;
  point.residual = comparison.measured() - predicted;
  point.cost = comparison.misfit(point.residual) + priorCost(problem, point.z);
  return point;
}

Eigen::VectorXd secant(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, Eigen::Index coordinate,
                       double difference) {
  for (const double side : {1.0, -1.0}) {
    const Eigen::VectorXd z = movedBy(at.z, coordinate, side * difference);
    if (problem.clamped(z)[coordinate] == at.z[coordinate]) continue;  // at a bound
    const FitPoint beside = evaluate(comparison, problem, z);
    if (beside.residual.size()) return (at.residual - beside.residual) / (beside.z[coordinate] - at.z[coordinate]);
  }
  return {};
}

Eigen::MatrixXd derivatives(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, double difference,
                            const std::vector<SharedVector>& known) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(comparison.size(), at.z.size());
  parallelFor(static_cast<int>(at.z.size()), comparison.plant().jobCount(), [&](int i) {
    if (const auto k = static_cast<std::size_t>(i); k < known.size() && known[k])
      jacobian.col(i) = *known[k];
    else if (const Eigen::VectorXd slope = secant(comparison, problem, at, i, difference); slope.size())
      jacobian.col(i) = slope;
  });
  return jacobian;
}

double stepOf(const FitProblem& problem, const Eigen::VectorXd& z, Eigen::Index coordinate) {
  for (const double side : {1.0, -1.0})
    if (const double step = problem.clamped(movedBy(z, coordinate, side * wide_difference))[coordinate] - z[coordinate]; step != 0)
      return step;
  return 0;
}

Eigen::MatrixXd derivatives(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& z) {
  const FitPoint at = evaluate(comparison, problem, z);
  if (!at.residual.size()) return Eigen::MatrixXd::Zero(comparison.size(), z.size());
  return derivatives(comparison, problem, at, wide_difference);
}

}  // namespace musclesim
