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
/// q, so that n - d combinations of them do not depend on what moves it. About the measured readings y of a row, those of a model are
///     y' = y + J dq + b(dq) + fault,   J = dy / dq (n x d),   b_i = dq^T B_i dq / 2,   B_i = d^2 y_i / dq^2 (d x d)
/// and what no pose explains is
///     e(y') = E (y' - b(G (y' - y))),   E = S (1 - A A^+) S^-1,   G = A^+ S^-1,   A = S^-1 J,   S_ii^2 = sigma_i^2 + (D^2 |B_i| / 2)^2
/// y, y', e: mm or degrees; sigma: noise floors; A^+: pseudoinverse; |B|: Frobenius norm; D = 5 mm, which is 0.05 rad. e(y) - e(y') is free
/// of dq up to its third power. A fault of one sensor, or a part that is mounted elsewhere than in the model, shows in it; what only moves
/// the robot does not. Signals that bend determine dq less: a hand without noise would otherwise determine it alone, and what J and B miss
/// of another motion would be a thousand times as much as its noise. Source: Potter and Suman 1977 (parity vector); Chow and Willsky 1984.
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
  /// e(readings) in a row, where `measured` was measured; both of signals().
  Eigen::VectorXd at(int row, const Eigen::VectorXd& readings, const Eigen::VectorXd& measured) const;
  /// The share (1 - A A^+)_ii of a signal, by its position in signals(), that remains beside the pose that it helps to determine.
  double shareBeyondPose(int row, Eigen::Index position) const;
  /// Variance of the noise of e_i, (E diag(sigma^2) E^T)_ii.
  double noiseVariance(int row, Eigen::Index position) const;

 private:
  struct Row {
    Eigen::MatrixXd relation;           ///< E
    Eigen::VectorXd noise_variance;     ///< of e
    Eigen::MatrixXd to_pose;            ///< G
    std::vector<Eigen::MatrixXd> bend;  ///< B_i
  };

  std::vector<int> signals_;
  std::vector<Row> rows_;
  int count_ = 0;
};

}  // namespace musclesim
