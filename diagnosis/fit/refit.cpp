#include "refit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "linear_model.h"

namespace musclesim {

namespace {

/// One step that decreases the misfit, with at most three dampings; false if there is none, or if it should gain less than is enough.
bool stepDown(const Comparison& comparison, const FitProblem& problem, const Eigen::MatrixXd& jacobian, double& damping, FitPoint& best) {
  const Eigen::VectorXd weights = comparison.weights(best.residual);
  const Eigen::MatrixXd weighted = weights.asDiagonal() * jacobian;
  Eigen::MatrixXd normal = weighted.transpose() * weighted;
  Eigen::VectorXd slope = weighted.transpose() * weights.cwiseProduct(best.residual);
  if (problem.precision.size()) {
    normal.diagonal() += problem.precision;
    slope -= problem.precision.cwiseProduct(best.z);
  }
  for (int attempt = 0; attempt < 3; ++attempt) {
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-9;
    const Eigen::VectorXd step = damped.ldlt().solve(slope);
    if (slope.dot(step) - 0.5 * step.dot(normal * step) < problem.enough) return false;
    FitPoint next = evaluate(comparison, problem, best.z + step);
    if (next.cost < best.cost) {
      best = std::move(next);
      damping *= 0.2;
      return true;
    }
    damping = std::max(damping * 10, 0.1);
  }
  return false;
}

/// Rank-one update of the derivatives from the step just made.
void update(Eigen::MatrixXd& jacobian, const FitPoint& from, const FitPoint& to) {
  const Eigen::VectorXd step = to.z - from.z;
  if (step.squaredNorm() > 0) jacobian += (from.residual - to.residual - jacobian * step) * step.transpose() / step.squaredNorm();
}

/// The least cost that the linear model about a point promises, within the bounds of the coordinates.
double promisedCost(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, const Eigen::MatrixXd& jacobian) {
  constexpr double farthest = 100;  // times the size of a coordinate, 1 if that is larger
  std::vector<LinearModel::Column> columns;
  std::vector<std::size_t> all;
  for (Eigen::Index k = 0; k < jacobian.cols(); ++k) {
    const double least = problem.clamped(movedBy(at.z, k, -farthest))[k], most = problem.clamped(movedBy(at.z, k, farthest))[k];
    const double precision = problem.precision.size() ? problem.precision[k] : 0;
    all.push_back(columns.size());
    columns.push_back({shared(jacobian.col(k)), least - at.z[k], most - at.z[k], precision, at.z[k]});
  }
  return LinearModel(comparison, at.residual, std::move(columns)).solve(all).cost;
}

/// Of a fit that has no derivatives.
Certainty allDetermined(Eigen::Index count) {
  return {Eigen::VectorXd::Zero(count), Eigen::VectorXd::Ones(count)};
}

}  // namespace

FitResult fit(const Comparison& comparison, const FitProblem& problem, int round_count) {
  FitPoint best = evaluate(comparison, problem, problem.start);
  if (!best.residual.size() || best.z.size() == 0 || round_count == 0)
    return {best.z, best.residual, best.cost, allDetermined(best.z.size()), {}};
  double difference = wide_difference;
  Eigen::MatrixXd jacobian = derivatives(comparison, problem, best, difference, problem.known_derivatives);
  const bool is_known = !problem.known_derivatives.empty();
  bool fresh = !is_known;
  double gained = is_known && problem.known_elsewhere ? std::numeric_limits<double>::infinity() : 0;  // since the derivatives
  double damping = 0.01;
  bool is_hopeless = false;
  for (int round = 0; round < round_count && !comparison.plant().interrupted(); ++round) {
    const bool was_hopeless = is_hopeless;
    is_hopeless = std::isfinite(problem.largest_cost) && promisedCost(comparison, problem, best, jacobian) > problem.largest_cost;
    if (is_hopeless && was_hopeless) break;
    const FitPoint before = best;
    const bool down = stepDown(comparison, problem, jacobian, damping, best);
    const bool settled = best.cost > before.cost - problem.enough;
    gained += before.cost - best.cost;
    if (settled && gained < problem.still_valid) break;
    if ((settled && fresh && (difference == narrow_difference || !problem.narrow_differences)) || round + 1 == round_count) break;
    if (settled) {
      if (fresh && problem.narrow_differences) difference = narrow_difference;
      std::vector<SharedVector> kept(static_cast<std::size_t>(jacobian.cols()));
      for (Eigen::Index k = problem.renewed_count; k >= 0 && k < jacobian.cols(); ++k)
        kept[static_cast<std::size_t>(k)] = std::make_shared<const Eigen::VectorXd>(jacobian.col(k));
      jacobian = derivatives(comparison, problem, best, difference, kept);
      gained = 0;
    } else if (down) {
      update(jacobian, before, best);
    }
    fresh = settled;
  }
  return {best.z, best.residual, best.cost, certaintyOf(comparison, problem, best, withoutErrors(comparison, jacobian)), jacobian};
}

FitResult finish(const Comparison& comparison, const FitProblem& cheap, const Predicted& exact, const Eigen::VectorXd& residual,
                 const Predicted& finer) {
  constexpr int step_count = 4;
  constexpr double exactly_enough = 1e-6;  // nats of the tempered misfit: a step of about a tenth of a standard error
  FitPoint best{cheap.start, residual, comparison.misfit(residual) + priorCost(cheap, cheap.start)};
  if (best.z.size() == 0) return {best.z, best.residual, best.cost, {}, {}};
  const Derivatives near = derivativesAt(comparison, cheap, residual);
  FitProblem exactly = cheap;
  exactly.predicted = exact;
  exactly.enough = exactly_enough;
  double damping = 1e-3;
  Eigen::MatrixXd jacobian = near.jacobian;
  for (int step = 0; step < step_count; ++step) {
    const FitPoint before = best;
    if (!stepDown(comparison, exactly, jacobian, damping, best)) break;
    update(jacobian, before, best);
  }
  Eigen::VectorXd step_change = finer ? finer(best.z) : Eigen::VectorXd{};
  if (step_change.size()) step_change -= comparison.measured() - best.residual;
  return {best.z, best.residual, best.cost, certaintyOf(comparison, cheap, best, near, step_change), jacobian};
}

FitResult fitCorrected(const Comparison& comparison, const FitProblem& cheap, const Predicted& exact, int round_count) {
  constexpr int pass_count = 2;
  FitProblem exactly = cheap;
  exactly.predicted = exact;
  FitPoint best = evaluate(comparison, exactly, cheap.start);
  FitResult result{best.z, best.residual, best.cost, allDetermined(best.z.size()), {}};
  for (int pass = 0; pass < pass_count && best.residual.size() && !comparison.plant().interrupted(); ++pass) {
    const Eigen::VectorXd before = cheap.predicted(best.z);
    if (before.size() != comparison.size()) break;
    FitProblem corrected = cheap;
    corrected.start = best.z;
    const Eigen::VectorXd shift = comparison.measured() - best.residual - before;
    corrected.predicted = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd {
      const Eigen::VectorXd predicted = cheap.predicted(z);
      return predicted.size() == shift.size() ? predicted + shift : predicted;
    };
    const FitResult fitted = fit(comparison, corrected, round_count);
    result.certainty = fitted.certainty;
    result.jacobian = fitted.jacobian;
    if (fitted.cost > best.cost - cheap.enough) break;
    FitPoint next = evaluate(comparison, exactly, fitted.z);
    if (next.cost > best.cost - cheap.enough) break;
    best = std::move(next);
  }
  result.z = best.z;
  result.residual = best.residual;
  result.cost = best.cost;
  return result;
}

}  // namespace musclesim
