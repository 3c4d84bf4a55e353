#include "least_squares.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

/// Steps of the difference quotients: relative to the parameter, and the least step.
constexpr double relative_step = 1e-6, least_step = 1e-8;

/// The whole problem as one residual block, so that each evaluation builds the law only once for all points.
class Block final : public ceres::CostFunction {
 public:
  explicit Block(const LeastSquaresProblem& problem) : problem_(problem) {
    set_num_residuals(problem.residual_count);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.lowest.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    try {
      const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(parameters[0], problem_.lowest.size());
      Eigen::VectorXd r(problem_.residual_count);
      problem_.residuals(x, r);
      if (!r.allFinite()) return false;
      Eigen::Map<Eigen::VectorXd>(residuals, problem_.residual_count) = r;
      if (!jacobians || !jacobians[0]) return true;
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      const Eigen::MatrixXd jacobian = jacobianOf(problem_, x);
      Eigen::Map<RowMajor>(jacobians[0], problem_.residual_count, x.size()) = jacobian;
      return jacobian.allFinite();
    } catch (const Error&) {
      return false;
    }
  }

 private:
  const LeastSquaresProblem& problem_;
};

ceres::Solver::Options solverOptions() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-10;
  options.gradient_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  return options;
}

bool isUsable(const ceres::Solver::Summary& summary) {
  return summary.IsSolutionUsable() && std::isfinite(summary.final_cost);
}

}  // namespace

Eigen::MatrixXd jacobianOf(const LeastSquaresProblem& problem, const Eigen::VectorXd& x) {
  Eigen::MatrixXd jacobian(problem.residual_count, x.size());
  Eigen::VectorXd moved = x, above(problem.residual_count), below(problem.residual_count);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double step = std::max(relative_step * std::abs(x(i)), least_step);
    const double high = std::min(x(i) + step, problem.highest(i)), low = std::max(x(i) - step, problem.lowest(i));
    moved(i) = high;
    problem.residuals(moved, above);
    moved(i) = low;
    problem.residuals(moved, below);
    moved(i) = x(i);
    jacobian.col(i) = (above - below) / (high - low);
  }
  return jacobian;
}

LeastSquaresResult minimise(const LeastSquaresProblem& problem, const std::vector<Eigen::VectorXd>& starts) {
  LeastSquaresResult best;
  best.sum_of_squares = std::numeric_limits<double>::infinity();
  for (const Eigen::VectorXd& start : starts) {
    Eigen::VectorXd x = start.cwiseMax(problem.lowest).cwiseMin(problem.highest);
    ceres::Problem ceres_problem;
    ceres_problem.AddResidualBlock(new Block(problem), nullptr, x.data());
    for (int i = 0; i < static_cast<int>(x.size()); ++i) {
      ceres_problem.SetParameterLowerBound(x.data(), i, problem.lowest(i));
      ceres_problem.SetParameterUpperBound(x.data(), i, problem.highest(i));
    }
    ceres::Solver::Summary summary;
    ceres::Solve(solverOptions(), &ceres_problem, &summary);
    if (!isUsable(summary) || 2 * summary.final_cost >= best.sum_of_squares) continue;
    best = {x, 2 * summary.final_cost, summary.termination_type == ceres::CONVERGENCE};
  }
  if (best.x.size() == 0) throw Error("least squares: no start leads to a solution");
  return best;
}

}  // namespace musclesim
