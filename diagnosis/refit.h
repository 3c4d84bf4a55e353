/// Fits a few numbers of a model to recordings.
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

/// d(prediction)/dz at z, column by column: differences of 5 % of the coordinate, at least 0.02, to the side where the model goes on; zero
/// where it does on neither.
Eigen::MatrixXd derivatives(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& z);

/// The step of one coordinate with which derivatives() begins, to the side where there is room; 0 between two bounds.
double stepOf(const FitProblem& problem, const Eigen::VectorXd& z, Eigen::Index coordinate);

/// Minimises Comparison::logMisfit with Levenberg and Marquardt's method on residuals that are weighted anew in every round (Marquardt
/// 1963); the response may have kinks, so the differences for derivatives are not small. They are found anew when a step
/// gains nothing, otherwise carried on by rank-one updates (Broyden 1965), since simulations are what a fit costs.
/// The intervals are those of the linearised problem with the residual's own variance, widened by the number of samples over the
/// effective number of samples (from the residual's autocorrelation).
FitResult fit(const Comparison& comparison, const FitProblem& problem, int round_count);

/// The same for an exact prediction that costs more than the one of the problem. That one is fitted with what it lacks at the start added,
/// the result is predicted exactly, and once more from there (additive correction, Alexandrov and Lewis 2001). The residual is the exact
/// one, and never worse than that at the start.
FitResult fitCorrected(const Comparison& comparison, const FitProblem& cheap, const Predicted& exact, int round_count);

}  // namespace musclesim
