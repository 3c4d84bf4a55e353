/// Fits a few parameters of a model to recordings.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "comparison.h"

namespace musclesim {

/// The prediction at the compared rows for given coordinates; empty if the model diverges.
using Predicted = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

struct FitProblem {
  Predicted predicted;
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> clamped;
  Eigen::VectorXd start;
};

struct FitResult {
  Eigen::VectorXd z;
  Eigen::VectorXd residual;  ///< measured - predicted; empty if no prediction could be made
  double log_misfit = 0;
  Eigen::VectorXd half_width;  ///< half of the 95 % interval of every coordinate; infinite: not determined
};

/// d(prediction)/dz at z, column by column, from one-sided differences: 20 % of the coordinate, at least 0.2, to the side where the model
/// does not diverge; zero if it diverges on both sides.
Eigen::MatrixXd derivatives(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& z);

/// The step of one coordinate that derivatives() tries first, within the bounds; 0 between two bounds.
double stepOf(const FitProblem& problem, const Eigen::VectorXd& z, Eigen::Index coordinate);

/// Minimises Comparison::logMisfit with Levenberg and Marquardt's method (Marquardt 1963) on residuals that are reweighted in every round.
/// The response may have kinks, so the differences for derivatives are not small. Because simulations dominate the cost, derivatives are
/// recomputed only when a step gains nothing; otherwise rank-one updates carry them on (Broyden 1965). The intervals are those of the
/// linearised problem with the residual's own variance, widened by the number of samples over the effective number of samples (from the
/// residual's autocorrelation).
FitResult fit(const Comparison& comparison, const FitProblem& problem, int round_count);

/// Two-fidelity fit: minimises the misfit of the cheap prediction plus the exact-minus-cheap difference at the start, predicts the result
/// exactly, and repeats once from there (additive correction, Alexandrov and Lewis 2001). The residual is that of the exact prediction,
/// never worse than at the start.
FitResult fitCorrected(const Comparison& comparison, const FitProblem& cheap, const Predicted& exact, int round_count);

}  // namespace musclesim
