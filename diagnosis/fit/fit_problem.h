/// What is fitted: a prediction with a few coordinates, their bounds and priors, and its slopes.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "comparison.h"

namespace musclesim {

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

/// Coordinates within their bounds and what they predict.
struct FitPoint {
  Eigen::VectorXd z;
  Eigen::VectorXd residual;                               ///< measured - predicted; empty if no prediction could be made
  double cost = std::numeric_limits<double>::infinity();  ///< misfit + sum of precision z^2 / 2, in nats
};

FitPoint evaluate(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& z);

/// The cost of coordinates by their priors alone, in nats.
double priorCost(const FitProblem& problem, const Eigen::VectorXd& z);

/// Differences for derivatives, in coordinates. Wide ones first: dry friction hides small changes, so that the tangent is flatter than the
/// secant.
inline constexpr double wide_difference = 0.2, narrow_difference = 0.05;

/// z with one coordinate moved by `difference` times its size, or times 1 if that is larger.
Eigen::VectorXd movedBy(Eigen::VectorXd z, Eigen::Index coordinate, double difference);

/// d(prediction)/dz of one coordinate from a one-sided difference (movedBy), to the side where the model does not diverge; empty if it
/// diverges on both sides, or between two bounds.
Eigen::VectorXd secant(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, Eigen::Index coordinate,
                       double difference);

/// The secants of all coordinates as columns; zero where there is none. `known`: columns that need no prediction.
Eigen::MatrixXd derivatives(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, double difference,
                            const std::vector<SharedVector>& known = {});

/// The same at z with wide differences.
Eigen::MatrixXd derivatives(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& z);

/// The step of one coordinate that derivatives() at z tries first, within the bounds; 0 between two bounds.
double stepOf(const FitProblem& problem, const Eigen::VectorXd& z, Eigen::Index coordinate);

}  // namespace musclesim
