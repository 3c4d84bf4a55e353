/// The mathematics that the attractor controllers share: mixture of attractors, fluctuating state, pressures, decision timing.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "musclesim/base/random.h"
#include "musclesim/controller/controller.h"

namespace musclesim {

/// Attractors xi_i of the controller's state x, all in [-1, 1]^n. A Gaussian mixture with one common width blends their pulls.
///     f(x) = sum_i N_i(x) (xi_i - x),   N_i = g_i / sum_j g_j,   g_i = exp(-|xi_i - x|^2 / (2 width^2))      (Eq. 6)
/// All quantities are pure numbers. The largest exponent is factored out of the weights N_i, so that they are finite and sum to 1
/// however far x is from all attractors. f(x) points from x into the convex hull of the attractors: x + f(x) stays in [-1, 1]^n.
/// Source: attractor selection by fluctuation, Kashiwagi, Urabe, Kaneko and Yomo 2006; for the arm Braun 2007. The normalised Gaussian
/// weights are the form implemented here.
class AttractorMixture {
 public:
  /// n x k matrix, one attractor per column; n, k at least 1, width above 0. Throws BadParameter otherwise.
  AttractorMixture(Eigen::MatrixXd attractors, double width);
  /// k attractors of dimension n, drawn column by column: entries sign(u) |u|^exponent with u uniform in [-1, 1).
  /// Exponent 1 gives uniform entries. Smaller exponents gather them near -1 and 1, where the pressures are saturated: there, fluctuation
  /// about an attractor hardly moves the robot. The published program draws from {-1, 0, 1}.
  static AttractorMixture random(int n, int k, double width, double exponent, RandomStream& stream);

  /// N_i(x): k numbers in 0..1 that sum to 1 (also called responsibilities).
  Eigen::VectorXd weights(const Eigen::VectorXd& x) const;
  /// f(x) of Eq. 6, n numbers.
  Eigen::VectorXd drift(const Eigen::VectorXd& x) const;

  const Eigen::MatrixXd& attractors() const { return attractors_; }
  /// Replaces all attractors. Throws BadParameter if the shape differs.
  void replace(const Eigen::MatrixXd& attractors);

 private:
  Eigen::MatrixXd attractors_;
  double width_;
};

/// One step of Eq. 5, dx/dt = alpha f(x) + eta, discretised (Euler and Maruyama):
///     x <- clip(x + pull f(x) + noise_std N(0, 1)),   pull = min(max(step alpha, 0), 1)
/// The upper limit 1 keeps the state from jumping past the attractors. With a negative activity only the fluctuation remains (in the
/// continuous form it would push the state away from the attractors, into the corners of the box). `step_times_activity` is step alpha.
/// Returns the new state in [-1, 1]^n.
Eigen::VectorXd fluctuated(const Eigen::VectorXd& x, const AttractorMixture& mixture, double step_times_activity, double noise_std,
                           RandomStream& noise);

/// Pressures of a state: p_i = (tanh(3 x_i) + 1) / 2, fractions of full scale in 0..1.
Action pressures(const Eigen::VectorXd& x);

/// Discounted mean of the past values of a signal; older values count less (Eq. 9):
///     A(t) = gamma (v(t-1) + A(t-1)),   B(t) = gamma (1 + B(t-1)),   mean(t) = A(t) / B(t),   A(0) = B(0) = 0
/// gamma in (0, 1]: 1 is the plain mean. The present value v(t) is not part of mean(t).
class DiscountedMean {
 public:
  explicit DiscountedMean(double gamma) : gamma_(gamma) {}
  /// Mean of all values added so far; `present` as long as there are none.
  double meanOr(double present) const { return B_ > 0 ? A_ / B_ : present; }
  /// Adds the present value to the past.
  void add(double value);

 private:
  double gamma_, A_ = 0, B_ = 0;
};

/// Counts control steps and says at which of them the controller decides: the first, then every max(1, round(interval / step))-th.
class DecisionTimer {
 public:
  /// Throws BadParameter unless step and interval are finite and above 0 and their quotient is below 1e9.
  DecisionTimer(double interval_s, double step_s);
  explicit DecisionTimer(const ControllerRequest& request) : DecisionTimer(request.decision_interval_s, request.step_s) {}
  /// Call it once per control step: true if the controller decides at this step.
  bool due();
  int stepsPerDecision() const { return steps_; }

 private:
  int steps_;
  int next_in_ = 0;  ///< steps left until the next decision
};

}  // namespace musclesim
