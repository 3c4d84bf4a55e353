#include "certainty.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "../../base/parallel.h"

namespace musclesim {

namespace {

constexpr double normal_95 = 1.96;

/// Number of samples per independent sample of a signal, from the autocorrelation up to its first zero, averaged over segments.
double samplesPerIndependent(const Comparison& comparison, int signal, const Eigen::VectorXd& residual) {
  double sum = 0;
  int block_count = 0;
  for (const Comparison::Block& block : comparison.blocks()) {
    if (block.signal != signal || !block.isReading()) continue;
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
  return block_count ? sum / block_count : 1;
}

int signalCount(const Comparison& comparison) {
  return static_cast<int>(comparison.plant().signals().size());
}

/// One over the standard deviation of every row, larger where rows are not independent, in their own signal or in all on average: what one
/// signal's law has wrong may bend the numbers that another one tells. 0 for averages and parity, which repeat the readings. The norm of a
/// secant times these is one over the standard error of the coordinate.
Eigen::VectorXd perDeviation(const Comparison& comparison, const Eigen::VectorXd& residual) {
  Eigen::VectorXd per_independent(signalCount(comparison));
  for (int signal = 0; signal < signalCount(comparison); ++signal)
    per_independent[signal] = samplesPerIndependent(comparison, signal, residual);
  per_independent = per_independent.cwiseMax(per_independent.mean()).eval();
  Eigen::VectorXd result = Eigen::VectorXd::Zero(comparison.size());
  for (const Comparison::Block& block : comparison.blocks()) {
    if (!block.isReading()) continue;
    const double sigma = std::max(block.sigma, std::sqrt(comparison.meanSquare(block, residual)));
    result.segment(block.first, block.count()).setConstant(1 / (sigma * std::sqrt(per_independent[block.signal])));
  }
  return result;
}

/// The readings of one signal in all segments, out of a vector over all compared rows. Averages and parity are left out.
Eigen::VectorXd readingsOf(const Comparison& comparison, int signal, const Eigen::VectorXd& values) {
  Eigen::VectorXd result(values.size());
  Eigen::Index count = 0;
  for (const Comparison::Block& block : comparison.blocks()) {
    if (block.signal != signal || !block.isReading()) continue;
    result.segment(count, block.count()) = values.segment(block.first, block.count());
    count += block.count();
  }
  return result.head(count);
}

/// Replaces all rows of one signal, those computed from its readings too.
void takeSignal(const Comparison& comparison, int signal, const Eigen::VectorXd& from, Eigen::VectorXd& to) {
  for (const Comparison::Block& block : comparison.blocks())
    if (block.signal == signal) to.segment(block.first, block.count()) = from.segment(block.first, block.count());
}

/// How the prediction changes with one coordinate.
struct Slope {
  Eigen::VectorXd secant;  ///< empty: it could not be taken
  Eigen::VectorXd error;   ///< of each signal, relative to the secant
};

/// `weights`: one over the standard deviation of every row, for which the norm of a secant is one over the standard error of the
/// coordinate.
Slope slopeOf(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, Eigen::Index coordinate,
              const Eigen::VectorXd& weights) {
  constexpr double narrower = narrow_difference / wide_difference;
  constexpr double largest_error = 0.3;  // secants that differ more show a bend of the response, as dry friction makes it, or jumps
  constexpr double exact = 0.03;         // two effects that are less alike than 0.999 are told apart with that
  constexpr double standard_errors = 4;  // the width of a 95 % interval
  // Over a quarter of the step, a smooth response comes four times as close to its tangent, and one with jumps comes twice as close.
  constexpr double steadily = 0.7;
  const int signal_count = signalCount(comparison);
  const auto norm = [&](int signal, const Eigen::VectorXd& slope) { return readingsOf(comparison, signal, slope).norm(); };
  const auto differenceOf = [&](int signal, const Eigen::VectorXd& one, const Eigen::VectorXd& other) {
    return norm(signal, one - other) / std::max(norm(signal, one), 1e-300);
  };
  Slope best{secant(comparison, problem, at, coordinate, narrow_difference), Eigen::VectorXd::Zero(signal_count)};
  const Eigen::VectorXd wide = secant(comparison, problem, at, coordinate, wide_difference);
  if (!best.secant.size() || weights.cwiseProduct(best.secant).norm() <= 0) return best;
  if (!wide.size()) return {best.secant, Eigen::VectorXd::Constant(signal_count, largest_error)};  // the model diverges there
  std::set<int> improving;
  for (int signal = 0; signal < signal_count; ++signal) {
    best.error[signal] = differenceOf(signal, best.secant, wide);
    improving.insert(signal);
  }
  const double size = std::max(1.0, std::abs(at.z[coordinate]));
  for (double difference = narrow_difference; difference * size * weights.cwiseProduct(best.secant).norm() > standard_errors;) {
    std::erase_if(improving, [&](int signal) { return best.error[signal] <= exact; });
    if (improving.empty()) break;
    difference *= narrower;
    const Eigen::VectorXd nearer = secant(comparison, problem, at, coordinate, difference);
    if (!nearer.size()) break;
    for (const int signal : std::set<int>(improving)) {
      const double change = differenceOf(signal, nearer, best.secant);
      if (change > steadily * best.error[signal]) {
        improving.erase(signal);
        continue;
      }
      best.error[signal] = change;
      takeSignal(comparison, signal, nearer, best.secant);
    }
  }
  for (int signal = 0; signal < signal_count; ++signal) {
    if (best.error[signal] <= largest_error) continue;
    best.error[signal] = largest_error;
    if (norm(signal, wide) < norm(signal, best.secant)) takeSignal(comparison, signal, wide, best.secant);  // jumps, over a short step
  }
  return best;
}

}  // namespace

Certainty notDetermined(Eigen::Index count) {
  return {Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity()), Eigen::VectorXd::Zero(count)};
}

Derivatives withoutErrors(const Comparison& comparison, const Eigen::MatrixXd& jacobian) {
  return {jacobian, Eigen::MatrixXd::Zero(signalCount(comparison), jacobian.cols())};
}

Derivatives derivativesAt(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& residual) {
  const Eigen::Index count = problem.start.size();
  Derivatives found{Eigen::MatrixXd::Zero(comparison.size(), count), Eigen::MatrixXd::Zero(signalCount(comparison), count)};
  const FitPoint at = evaluate(comparison, problem, problem.start);
  if (!at.residual.size()) return found;
  const Eigen::VectorXd weights = perDeviation(comparison, residual);
  parallelFor(static_cast<int>(count), comparison.plant().jobCount(), [&](int k) {
    const Slope slope = slopeOf(comparison, problem, at, k, weights);
    if (slope.secant.size()) found.jacobian.col(k) = slope.secant;
    found.error.col(k) = slope.error;
  });
  return found;
}

Certainty certaintyOf(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, const Derivatives& derivatives,
                      const Eigen::VectorXd& step_change) {
  constexpr double nothing = 1e-12, flat = 1e-8, takes_part = 0.1;
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd weights = perDeviation(comparison, at.residual), residual = weights.cwiseProduct(at.residual);
  Eigen::VectorXd of_step = Eigen::VectorXd::Zero(residual.size());
  if (step_change.size() == residual.size()) of_step = weights.cwiseProduct(step_change);
  const Eigen::MatrixXd weighted = weights.asDiagonal() * derivatives.jacobian;
  const Eigen::MatrixXd information = weighted.transpose() * weighted;
  const Eigen::VectorXd precision = problem.precision.size() ? problem.precision : Eigen::VectorXd::Zero(weighted.cols());
  const Eigen::ArrayXd size = (information.diagonal() + precision).array().max(0).sqrt();
  // Scaled to unit size, so that a direction without influence shows in any units.
  const Eigen::VectorXd per_size = (size > nothing).select(size.inverse(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> of_data(per_size.asDiagonal() * information * per_size.asDiagonal());
  Eigen::MatrixXd known = precision.cwiseProduct(per_size.cwiseAbs2()).asDiagonal();
  Eigen::VectorXd slope = -per_size.cwiseProduct(precision).cwiseProduct(at.z), slope_of_step = Eigen::VectorXd::Zero(size.size());
  for (int signal = 0; signal < signalCount(comparison); ++signal) {
    Eigen::MatrixXd columns(readingsOf(comparison, signal, residual).size(), weighted.cols());
    for (Eigen::Index k = 0; k < columns.cols(); ++k) columns.col(k) = per_size[k] * readingsOf(comparison, signal, weighted.col(k));
    const Eigen::VectorXd downhill = columns.transpose() * readingsOf(comparison, signal, residual);
    const Eigen::VectorXd with_step = columns.transpose() * readingsOf(comparison, signal, of_step);
    const Eigen::VectorXd uncertain = columns.colwise().norm().transpose().cwiseProduct(derivatives.error.row(signal).transpose());
    for (Eigen::Index k = 0; k < size.size(); ++k) {
      const Eigen::VectorXd direction = of_data.eigenvectors().col(k);
      const double certain = (columns * direction).squaredNorm() - direction.cwiseProduct(uncertain).squaredNorm();
      if (certain <= 0) continue;
      known += certain * direction * direction.transpose();
      slope += direction.dot(downhill) * direction;
      slope_of_step += direction.dot(with_step) * direction;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions(known);
  Eigen::ArrayXd variance = Eigen::ArrayXd::Zero(size.size()), determined = Eigen::ArrayXd::Zero(size.size());
  Eigen::VectorXd to_least_squares = Eigen::VectorXd::Zero(size.size()), by_half_step = Eigen::VectorXd::Zero(size.size());
  for (Eigen::Index k = 0; k < size.size(); ++k) {
    const Eigen::VectorXd direction = directions.eigenvectors().col(k);
    const Eigen::ArrayXd share = direction.array().square();
    if (directions.eigenvalues()[k] > flat) {
      variance += share / directions.eigenvalues()[k];
      determined += share;
      to_least_squares += direction * (direction.dot(slope) / directions.eigenvalues()[k]);
      by_half_step += direction * (direction.dot(slope_of_step) / directions.eigenvalues()[k]);
    } else {
      variance = (share > takes_part * takes_part).select(unbounded, variance);
    }
  }
  const Eigen::VectorXd least_squares = problem.clamped(at.z + per_size.cwiseProduct(to_least_squares));
  constexpr double halves = 2;
  const Eigen::ArrayXd by_step = halves * per_size.cwiseProduct(by_half_step).array().abs();
  const Eigen::ArrayXd half_width = normal_95 * variance.sqrt() * per_size.array() + (least_squares - at.z).array().abs() + by_step;
  return {(size > nothing).select(half_width, unbounded), determined};
}

}  // namespace musclesim
