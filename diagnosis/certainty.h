/// How well the data and the priors determine the coordinates of a fit.
#pragma once

#include <Eigen/Core>

#include "fit_problem.h"

namespace musclesim {

struct Certainty {
  Eigen::VectorXd half_width;  ///< half of the 95 % interval of every coordinate; infinite: not determined
  /// Share of every coordinate in the directions that are determined, 0 .. 1. The sum is the number of these directions: two coordinates of
  /// which only the ratio shows are one.
  Eigen::VectorXd determined;
};

Certainty notDetermined(Eigen::Index count);

/// Derivatives near a point and how well they are known.
struct Derivatives {
  Eigen::MatrixXd jacobian;  ///< d(prediction)/dz, one column per coordinate
  Eigen::VectorXd error;     ///< of each column, relative to it
};

/// Secants at problem.start over the narrow difference, or over shorter ones. A step is shortened, down to the width of the coordinate's
/// own interval, as long as the secant comes steadily closer to the tangent. Under steep commands, where a signal bends within a short
/// step, it does; where dry friction hides small changes, it does not. The error is the difference from a secant four times as wide.
Derivatives derivativesAt(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& residual);

/// The intervals of the linearised problem about a point, with the residual's own variance. They are widened by the number of samples over
/// the effective number of samples (from the residual's autocorrelation), and by the distance to the least squares of all readings: the
/// minimum of the tempered misfit lies a standard error or two from there where only noise remains, and further where the model is wrong.
///
/// A direction in which the columns cancel to less than their errors is not known, and the half width of a coordinate that takes part in it
/// is infinite.
Certainty certaintyOf(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, const Derivatives& derivatives);

}  // namespace musclesim
