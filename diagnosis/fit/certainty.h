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
  Eigen::MatrixXd error;     ///< [signal][coordinate]: of the signal's part of a column, relative to it
};

/// Derivatives that are taken to have no errors.
Derivatives withoutErrors(const Comparison& comparison, const Eigen::MatrixXd& jacobian);

/// Secants at problem.start over the narrow difference, or over others, signal by signal: where the chain of a rig shakes, its length
/// jumps while its pressure follows smoothly. A step is shortened, down to the width of the coordinate's own interval, as long as a
/// signal's secant comes steadily closer to the tangent. Under steep commands, where a signal bends within a short step, it does; where dry
/// friction hides small changes, it does not. The error is the difference from a secant four times as wide. Of a signal whose secants
/// differ by more than 0.3 in the end, the flatter one of the shortest and the widest is taken: a jump over a short step looks like a steep
/// response.
Derivatives derivativesAt(const Comparison& comparison, const FitProblem& problem, const Eigen::VectorXd& residual);

/// The intervals of the linearised problem about a point, with the residual's own variance. They are widened by the number of samples over
/// the effective number of samples (from the residual's autocorrelation, of the signal or of all on average), and by the distance to the
/// least squares of all readings: the minimum of the tempered misfit lies a standard error or two from there where only noise remains, and
/// further where the model is wrong.
///
/// The errors of the derivatives alone could feign some information about a direction; from the information of each signal that much is
/// subtracted. If nothing is left of any signal, the direction is not known, and every coordinate that takes part in it has an infinite
/// half width.
///
/// `step_change`: what half the time step changes in the prediction, empty if that is not asked. The error of the whole step is twice that,
/// because the stepper is of first order; what the coordinates would change with it widens the intervals, too.
Certainty certaintyOf(const Comparison& comparison, const FitProblem& problem, const FitPoint& at, const Derivatives& derivatives,
                      const Eigen::VectorXd& step_change = {});

}  // namespace musclesim
