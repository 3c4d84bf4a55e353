#include "certainty.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../base/parallel.h"

namespace musclesim {

namespace {

constexpr double normal_95 = 1.96;

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

/// One over the standard deviation of every row, larger where rows are not independent: the norm of a secant times these is one over the
/// standard error of the coordinate.
Eigen::VectorXd perDeviation(const Comparison& comparison, const Eigen::VectorXd& residual) {
  return perSample(comparison, residual) / std::sqrt(samplesPerIndependent(comparison, residual));
}

/// How the prediction changes with one coordinate.
struct Slope {
  Eigen::VectorXd secant;  ///< empty: it could not be taken
  double error = 0;        ///< relative to the secant
};

/// `weights`: one over the standard deviation of every row, for which the norm of a secant is one over the standard error of the
/// coordinate.
Slope slopeOf(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, Eigen::Index coordinate,
              const Eigen::VectorXd& weights) {
  constexpr double narrower = narrow_difference / wide_difference;
  constexpr double largest_error = 0.3;  // secants that differ more show a bend of the response, as dry friction makes it
  constexpr double exact = 0.03;         // two effects that are less alike than 0.999 are told apart with that
  constexpr double standard_errors = 4;  // the width of a 95 % interval
  // Over a quarter of the step, a smooth response comes four times as close to its tangent, and one with jumps comes twice as close.
  constexpr double steadily = 0.7;
  const auto norm = [&](const Eigen::VectorXd& slope) { return weights.cwiseProduct(slope).norm(); };
  Eigen::VectorXd far = secant(comparison, problem, at, coordinate, wide_difference);
  Eigen::VectorXd near = secant(comparison, problem, at, coordinate, narrow_difference);
  if (!near.size() || norm(near) <= 0) return {near, 0};
  if (!far.size()) return {near, largest_error};  // the model diverges there
  Slope best{near, norm(far - near) / norm(near)};
  const double size = std::max(1.0, std::abs(at.z[coordinate]));
  double difference = narrow_difference;
  while (best.error > exact && difference * size * norm(best.secant) > standard_errors) {
    difference *= narrower;
    far = std::exchange(near, secant(comparison, problem, at, coordinate, difference));
    if (!near.size() || norm(far - near) > steadily * best.error * norm(near)) break;
    best = {near, norm(far - near) / norm(near)};
  }
  best.error = std::min(best.error, largest_error);
  return best;
}

}  // namespace

Certainty notDetermined(Eigen::Index count) {
  return {Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity()), Eigen::VectorXd::Zero(count)};
}

Derivatives derivativesAt(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& residual) {
  const Eigen::Index count = problem.start.size();
  Derivatives found{Eigen::MatrixXd::Zero(comparison.size(), count), Eigen::VectorXd::Zero(count)};
  const FitPoint at = evaluate(comparison, problem, problem.start);
  if (!at.residual.size()) return found;
  const Eigen::VectorXd weights = perDeviation(comparison, residual);
  parallelFor(static_cast<int>(count), comparison.plant().jobCount(), [&](int k) {
    const Slope slope = slopeOf(comparison, problem, at, k, weights);
    if (slope.secant.size()) found.jacobian.col(k) = slope.secant;
    found.error[k] = slope.error;
  });
  return found;
}

Certainty certaintyOf(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, const Derivatives& derivatives) {
  constexpr double nothing = 1e-12, flat = 1e-8, takes_part = 0.1;
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  const auto& [jacobian, error] = derivatives;
  const Eigen::VectorXd weights = perDeviation(comparison, at.residual);
  const Eigen::MatrixXd weighted = weights.asDiagonal() * jacobian;
  const Eigen::MatrixXd information = weighted.transpose() * weighted;
  const Eigen::VectorXd precision = problem.precision.size() ? problem.precision : Eigen::VectorXd::Zero(jacobian.cols());
  const Eigen::VectorXd slope = weighted.transpose() * weights.cwiseProduct(at.residual) - precision.cwiseProduct(at.z);
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
  Eigen::ArrayXd variance = Eigen::ArrayXd::Zero(size.size()), determined = Eigen::ArrayXd::Zero(size.size());
  Eigen::VectorXd to_least_squares = Eigen::VectorXd::Zero(size.size());
  for (Eigen::Index k = 0; k < size.size(); ++k) {
    const Eigen::VectorXd direction = directions.eigenvectors().col(k);
    const Eigen::ArrayXd share = direction.array().square();
    if (directions.eigenvalues()[k] > flat) {
      variance += share / directions.eigenvalues()[k];
      determined += share;
      to_least_squares += direction * (direction.dot(per_size.cwiseProduct(slope)) / directions.eigenvalues()[k]);
    } else {
      variance = (share > takes_part * takes_part).select(unbounded, variance);
    }
  }
  const Eigen::VectorXd least_squares = problem.clamped(at.z + per_size.cwiseProduct(to_least_squares));
  const Eigen::ArrayXd half_width = normal_95 * variance.sqrt() * per_size.array() + (least_squares - at.z).array().abs();
  return {(size > nothing).select(half_width, unbounded), determined};
}

}  // namespace musclesim
