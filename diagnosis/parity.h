/// Parity relations: how the signals of motion must agree with each other, whatever moves the robot.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"
#include "musclesim/simulation/replay.h"

namespace musclesim {

/// Whether a signal is an angle, a muscle's length or a coordinate of the hand.
bool isMotion(const std::string& signal);

/// The parity relations of one recording's signals of motion. All n of them follow from the pose of the robot, which has d free coordinates
/// q, so that n - d combinations do not depend on what moves it:
///     e = S (1 - A A^+) S^-1 y,   A = S^-1 J,   J = dy / dq (n x d),   S = diag(sigma)
/// y: readings of one row, mm or degrees; sigma: their noise floors; A^+: pseudoinverse; J is taken in the measured pose. e has the units
/// of y. A fault of one sensor, or a part that is mounted elsewhere than in the model, shows in e; what only moves the robot does not, as
/// far as the motion differs from the measured one by little enough for J to hold. Source: Potter and Suman 1977 (parity vector); Chow and
/// Willsky 1984.
class ParityRelations {
 public:
  /// `signals`: indices of compared signals of motion, `names` and `sigmas` those of all compared signals. There are no relations if the
  /// readings do not determine the pose or are not more than the free coordinates, or if bones form a loop.
  ParityRelations(const Recording& recording, const ReplayOptions& model, std::vector<int> signals, const std::vector<std::string>& names,
                  const std::vector<double>& sigmas);

  /// Number of independent relations, n - d; 0 if there are none.
  int count() const { return count_; }
  /// The compared signals among which they hold.
  const std::vector<int>& signals() const { return signals_; }
  /// The matrix S (1 - A A^+) S^-1 of a row.
  const Eigen::MatrixXd& at(int row) const { return relations_[static_cast<std::size_t>(row)]; }
  /// The share (1 - A A^+)_ii of the variance of a signal's noise that remains in e, by its position in signals().
  double shareOfVariance(int row, Eigen::Index position) const { return at(row)(position, position); }

 private:
  std::vector<int> signals_;
  std::vector<Eigen::MatrixXd> relations_;
  int count_ = 0;
};

}  // namespace musclesim
