#include "refit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "../base/parallel.h"
#include "linear_model.h"

namespace musclesim {

namespace {

constexpr double normal_95 = 1.96;
/// Differences for derivatives, in coordinates. Wide ones first: dry friction hides small changes, so that the tangent is flatter than the
/// secant.
constexpr double wide = 0.2, narrow = 0.05;

/// z with one coordinate moved by `difference` times its size, or times 1 if that is larger.
Eigen::VectorXd movedBy(Eigen::VectorXd z, Eigen::Index coordinate, double difference) {
  z[coordinate] += difference * std::max(1.0, std::abs(z[coordinate]));
  return z;
}

double priorCost(const FitProblem& problem, const Eigen::VectorXd& z) {
  return problem.precision.size() ? 0.5 * z.cwiseAbs2().dot(problem.precision) : 0;
}

struct Point {
  Eigen::VectorXd z, residual;
  double cost = std::numeric_limits<double>::infinity();
};

Point evaluate(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& z) {
  Point point{problem.clamped(z), {}};
  const Eigen::VectorXd predicted = problem.predicted(point.z);
  if (predicted.size() != comparison.size() || !predicted.allFinite()) return point;
  point.residual = comparison.measured() - predicted;
  point.cost = comparison.misfit(point.residual) + priorCost(problem, point.z);
  return point;
}

Eigen::MatrixXd derivatives(const Comparison& comparison, const FitProblem& problem, const Point& at, double difference,
                            const std::vector<SharedVector>& known = {}) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(comparison.size(), at.z.size());
  parallelFor(static_cast<int>(at.z.size()), comparison.plant().jobCount(), [&](int i) {
    if (const auto k = static_cast<std::size_t>(i); k < known.size() && known[k]) {
      jacobian.col(i) = *known[k];
      return;
    }
    for (const double side : {1.0, -1.0}) {
      const Eigen::VectorXd z = movedBy(at.z, i, side * difference);
      if (problem.clamped(z)[i] == at.z[i]) continue;  // at a bound
      const Point beside = evaluate(comparison, problem, z);
      if (!beside.residual.size()) continue;
      jacobian.col(i) = (at.residual - beside.residual) / (beside.z[i] - at.z[i]);
      break;
    }
  });
  return jacobian;
}

/// 1 / max(sigma, RMS) of each row's block; 0 for averages and parity, which repeat the readings.
Eigen::VectorXd perSample(const Comparison& comparison, const Eigen::VectorXd& residual) {
  Eigen::VectorXd result(comparison.size());
  for (const Comparison::Block& block : comparison.blocks())
    result.segment(block.first, block.count())
        .setConstant(!block.isReading() ? 0 : 1 / std::max(block.sigma, std::sqrt(comparison.meanSquare(block, residual))));
  return result;
}

/// Number of samples per independent sample, from the autocorrelation up to its first zero, averaged over blocks.
double samplesPerIndependent(const Comparison& comparison, const Eigen::VectorXd& residual) {
  double sum = 0;
  int block_count = 0;
  for (const Comparison::Block& block : comparison.blocks()) {
    if (!block.isReading()) continue;
    ++block_count;
    const Eigen::Index count = block.count();
    const Eigen::VectorXd r = residual.segment(block.first, count);
    const double power = std::max(r.squaredNorm(), 1e-300);
    double correlation_length = 1;
    for (Eigen::Index lag = 1; lag < count / 4; ++lag) {
      const double correlation = r.head(count - lag).dot(r.tail(count - lag)) / power;
      if (correlation <= 0) break;
      correlation_length += 2 * correlation;
    }
    sum += correlation_length;
  }
  return sum / block_count;
}

/// A half width is infinite if the data do not determine the coordinate, alone or together with the others.
/// `error`: relative error of each column of the Jacobian. A direction in which the columns cancel to less than their errors is not known.
Certainty certaintyOf(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& residual,
                      const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& error) {
  constexpr double nothing = 1e-12, flat = 1e-8, takes_part = 0.1;
  const Eigen::MatrixXd weighted = perSample(comparison, residual).asDiagonal() * jacobian;
  const Eigen::MatrixXd information = weighted.transpose() * weighted / samplesPerIndependent(comparison, residual);
  const Eigen::VectorXd precision = problem.precision.size() ? problem.precision : Eigen::VectorXd::Zero(jacobian.cols());
  const Eigen::ArrayXd size = (information.diagonal() + precision).array().max(0).sqrt();
  // Scaled to unit size, so that a direction without influence shows in any units.
  const Eigen::VectorXd per_size = (size > nothing).select(size.inverse(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> of_data(per_size.asDiagonal() * information * per_size.asDiagonal());
  Eigen::MatrixXd known = precision.cwiseProduct(per_size.cwiseAbs2()).asDiagonal();
  for (Eigen::Index k = 0; k < size.size(); ++k) {
    const Eigen::VectorXd direction = of_data.eigenvectors().col(k);
    const double certain = of_data.eigenvalues()[k] - direction.cwiseAbs2().dot(error.cwiseAbs2());
    if (certain > 0) known += certain * direction * direction.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions(known);
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  Eigen::ArrayXd variance = Eigen::ArrayXd::Zero(size.size()), determined = Eigen::ArrayXd::Zero(size.size());
  for (Eigen::Index k = 0; k < size.size(); ++k) {
    const Eigen::ArrayXd share = directions.eigenvectors().col(k).array().square();
    if (directions.eigenvalues()[k] > flat) {
      variance += share / directions.eigenvalues()[k];
      determined += share;
    } else {
      variance = (share > takes_part * takes_part).select(unbounded, variance);
    }
  }
  return {(size > nothing).select(normal_95 * variance.sqrt() * per_size.array(), unbounded), determined};
}

}  // namespace

namespace {

/// One step that decreases the misfit, with at most three dampings; false if there is none, or if it should gain less than is enough.
bool stepDown(const Comparison& comparison, const FitProblem& problem, const Eigen::MatrixXd& jacobian, double& damping, Point& best) {
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
    Point next = evaluate(comparison, problem, best.z + step);
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
void update(Eigen::MatrixXd& jacobian, const Point& from, const Point& to) {
  const Eigen::VectorXd step = to.z - from.z;
  if (step.squaredNorm() > 0) jacobian += (from.residual - to.residual - jacobian * step) * step.transpose() / step.squaredNorm();
}

/// The least cost that the linear model about a point promises, within the bounds of the coordinates.
double promisedCost(const Comparison& comparison, const FitProblem& problem, const Point& at, const Eigen::MatrixXd& jacobian) {
  constexpr double farthest = 100;  // times the size of a coordinate, 1 if that is larger
  std::vector<LinearModel::Column> columns;
  std::vector<std::size_t> all;
  for (Eigen::Index k = 0; k < jacobian.cols(); ++k) {
    const double least = problem.clamped(movedBy(at.z, k, -farthest))[k], most = problem.clamped(movedBy(at.z, k, farthest))[k];
    const double precision = problem.precision.size() ? problem.precision[k] : 0;
    all.push_back(columns.size());
    columns.push_back({jacobian.col(k), least - at.z[k], most - at.z[k], precision, at.z[k]});
  }
  return LinearModel(comparison, at.residual, std::move(columns)).solve(all).cost;
}

/// Of a fit that has no derivatives.
Certainty allDetermined(Eigen::Index count) {
  return {Eigen::VectorXd::Zero(count), Eigen::VectorXd::Ones(count)};
}

}  // namespace

double stepOf(const FitProblem& problem, const Eigen::VectorXd& z, Eigen::Index coordinate) {
  for (const double side : {1.0, -1.0})
    if (const double step = problem.clamped(movedBy(z, coordinate, side * wide))[coordinate] - z[coordinate]; step != 0) return step;
  return 0;
}

Eigen::MatrixXd derivatives(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& z) {
  const Point at = evaluate(comparison, problem, z);
  if (!at.residual.size()) return Eigen::MatrixXd::Zero(comparison.size(), z.size());
  return derivatives(comparison, problem, at, wide);
}

FitResult fit(const Comparison& comparison, const FitProblem& problem, int round_count) {
  Point best = evaluate(comparison, problem, problem.start);
  if (!best.residual.size() || best.z.size() == 0 || round_count == 0)
    return {best.z, best.residual, best.cost, allDetermined(best.z.size()), {}};
  double difference = wide;
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
    const Point before = best;
    const bool down = stepDown(comparison, problem, jacobian, damping, best);
    const bool settled = best.cost > before.cost - problem.enough;
    gained += before.cost - best.cost;
    if (settled && gained < problem.still_valid) break;
    if ((settled && fresh && (difference == narrow || !problem.narrow_differences)) || round + 1 == round_count) break;
    if (settled) {
      if (fresh && problem.narrow_differences) difference = narrow;
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
  return {best.z, best.residual, best.cost, certaintyOf(comparison, problem, best.residual, jacobian, Eigen::VectorXd::Zero(best.z.size())),
          jacobian};
}

Certainty notDetermined(Eigen::Index count) {
  return {Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity()), Eigen::VectorXd::Zero(count)};
}

Certainty certaintyAt(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& residual) {
  if (problem.start.size() == 0) return {};
  constexpr double largest_error = 0.3;  // secants that differ more show a bend of the response, as dry friction makes it
  const Point at = evaluate(comparison, problem, problem.start);
  if (!at.residual.size()) return notDetermined(problem.start.size());
  const Eigen::MatrixXd far = derivatives(comparison, problem, at, wide), near = derivatives(comparison, problem, at, narrow);
  const Eigen::VectorXd weights = perSample(comparison, residual);
  Eigen::VectorXd error = Eigen::VectorXd::Zero(near.cols());
  for (Eigen::Index k = 0; k < near.cols(); ++k)
    if (const double norm = weights.cwiseProduct(near.col(k)).norm(); norm > 0)
      error[k] = std::min(largest_error, weights.cwiseProduct(far.col(k) - near.col(k)).norm() / norm);
  return certaintyOf(comparison, problem, residual, near, error);
}

FitResult fitCorrected(const Comparison& comparison, const FitProblem& cheap, const Predicted& exact, int round_count) {
  constexpr int pass_count = 2;
  FitProblem exactly = cheap;
  exactly.predicted = exact;
  Point best = evaluate(comparison, exactly, cheap.start);
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
    Point next = evaluate(comparison, exactly, fitted.z);
    if (next.cost > best.cost - cheap.enough) break;
    best = std::move(next);
  }
  result.z = best.z;
  result.residual = best.residual;
  result.cost = best.cost;
  return result;
}

}  // namespace musclesim
