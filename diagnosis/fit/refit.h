/// Fits a few parameters of a model to recordings.
#pragma once

#include <Eigen/Core>

#include "certainty.h"
#include "comparison.h"
#include "fit_problem.h"

namespace musclesim {

struct FitResult {
  Eigen::VectorXd z;
  Eigen::VectorXd residual;  ///< measured - predicted; empty if no prediction could be made
  double cost = 0;           ///< misfit + sum of precision z^2 / 2, in nats
  Certainty certainty;
  Eigen::MatrixXd jacobian;  ///< d(prediction)/dz near z: the last derivatives, with rank-one updates since
};

/// Minimises the misfit (Comparison) plus the prior's cost with Levenberg and Marquardt's method (Marquardt 1963) on residuals that are
/// reweighted in every round. The response may have kinks, so the differences for derivatives are not small. Because simulations dominate
/// the cost, no step is tried that should gain less than FitProblem::enough by the derivatives, and these are recomputed only when no step
/// gains more; otherwise rank-one updates carry them on (Broyden 1965). For the intervals, the last
/// derivatives are taken to be exact.
FitResult fit(const Comparison& comparison, const FitProblem& problem, int round_count);

/// Two-fidelity fit: minimises the misfit of the cheap prediction plus the exact-minus-cheap difference at the start, predicts the result
/// exactly, and repeats once from there (additive correction, Alexandrov and Lewis 2001). The residual is that of the exact prediction,
/// never worse than at the start.
FitResult fitCorrected(const Comparison& comparison, const FitProblem& cheap, const Predicted& exact, int round_count);

/// Ends a fit at cheap.start, where measured minus the exact prediction is `residual`: derivatives over steps as short as the intervals
/// (derivativesAt, by the cheap prediction), up to four steps with them by the exact prediction, and the intervals. fit() ends when a step
/// gains less than FitProblem::enough of the tempered misfit; that may be many standard errors from the least one. `finer`, if given,
/// predicts with half the time step of the exact prediction: the intervals hold what the step changes.
FitResult finish(const Comparison& comparison, const FitProblem& cheap, const Predicted& exact, const Eigen::VectorXd& residual,
                 const Predicted& finer = {});

}  // namespace musclesim
