/// Fits a few parameters of a model to recordings.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "comparison.h"

namespace musclesim {

/// A derivative that many fits begin with; null: not known.
using SharedVector = std::shared_ptr<const Eigen::VectorXd>;

/// The prediction at the compared rows for given coordinates; empty if the model diverges.
using Predicted = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

struct FitProblem {
  Predicted predicted;
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> clamped;
  Eigen::VectorXd start;
  Eigen::VectorXd precision = {};  ///< of a normal prior of each coordinate about 0: 1 / variance; 0 or empty: none
  /// Derivatives of the prediction at the start by coordinate, where they are known; the others are computed.
  std::vector<SharedVector> known_derivatives = {};
  /// Only so many of the first coordinates get new derivatives later on; the known ones of the others are only updated. -1: all do.
  Eigen::Index renewed_count = -1;
  /// Nats: a decrease that does not justify another round. The misfit is tempered, so that intervals end far below 1.
  double enough = 5e-4;
  /// Nats that may be gained since the derivatives were computed without computing them again at the end.
  double still_valid = 0;
  bool known_elsewhere = true;     ///< the known derivatives are those of another place, so that still_valid does not hold for them
  bool narrow_differences = true;  ///< whether the last rounds use narrow differences
  /// Nats: the fit ends when the linear models about two places that it has reached, one after the other, promise no cost below this one.
  double largest_cost = std::numeric_limits<double>::infinity();
};

/// How well the data and the prior determine the coordinates of a fit.
struct Certainty {
  Eigen::VectorXd half_width;  ///< half of the 95 % interval of every coordinate; infinite: not determined
  /// Share of every coordinate in the directions that are determined, 0 .. 1. The sum is the number of these directions: two coordinates of
  /// which only the ratio shows are one.
  Eigen::VectorXd determined;
};

Certainty notDetermined(Eigen::Index count);

struct FitResult {
  Eigen::VectorXd z;
  Eigen::VectorXd residual;  ///< measured - predicted; empty if no prediction could be made
  double cost = 0;           ///< misfit + sum of precision z^2 / 2, in nats
  Certainty certainty;
  Eigen::MatrixXd jacobian;  ///< d(prediction)/dz near z: the last derivatives, with rank-one updates since
};

/// d(prediction)/dz at z, column by column, from one-sided differences: 20 % of the coordinate, at least 0.2, to the side where the model
/// does not diverge; zero if it diverges on both sides.
Eigen::MatrixXd derivatives(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& z);

/// The step of one coordinate that derivatives() tries first, within the bounds; 0 between two bounds.
double stepOf(const FitProblem& problem, const Eigen::VectorXd& z, Eigen::Index coordinate);

/// Minimises the misfit (Comparison) plus the prior's cost with Levenberg and Marquardt's method (Marquardt 1963) on residuals that are
/// reweighted in every round. The response may have kinks, so the differences for derivatives are not small. Because simulations dominate
/// the cost, no step is tried that should gain less than FitProblem::enough by the derivatives, and these are recomputed only when no step
/// gains more; otherwise rank-one updates carry them on (Broyden 1965). The
/// intervals are those of the linearised problem with the residual's own variance, widened by the number of samples over the effective
/// number of samples (from the residual's autocorrelation).
FitResult fit(const Comparison& comparison, const FitProblem& problem, int round_count);

/// Certainty of every coordinate at problem.start from fresh derivatives, with differences of two sizes: what these
/// disagree in is taken for the error of the derivatives, below which two coordinates that act alike are not told apart. `residual`:
/// measured minus the exact prediction there.
Certainty certaintyAt(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& residual);

/// Two-fidelity fit: minimises the misfit of the cheap prediction plus the exact-minus-cheap difference at the start, predicts the result
/// exactly, and repeats once from there (additive correction, Alexandrov and Lewis 2001). The residual is that of the exact prediction,
/// never worse than at the start.
FitResult fitCorrected(const Comparison& comparison, const FitProblem& cheap, const Predicted& exact, int round_count);

}  // namespace musclesim
