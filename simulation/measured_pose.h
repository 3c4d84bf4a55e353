/// The poses that a recording measured: to be drawn beside the simulated ones, and to tell how its signals depend on each other.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"
#include "musclesim/simulation/replay.h"
#include "snapshot.h"

namespace musclesim {

/// Signals of motion near a pose: y(q + dq) = y(q) + slope dq + dq^T bend dq / 2, in the units of the signals, dq in mm; a coordinate that
/// turns counts 100 mm per rad. Free coordinates of the skeleton only.
struct MotionExpansion {
  Eigen::MatrixXd slope;              ///< signals x coordinates
  std::vector<Eigen::MatrixXd> bend;  ///< per signal: coordinates x coordinates
};

/// Finds the pose of a recording's robot in each row from what was measured.
///
/// A coordinate q of the skeleton whose joint angle is measured has that angle. The others follow from the lengths of the muscles and,
/// where these do not determine them all, also from the position of the hand, by least squares (Levenberg and Marquardt):
///     minimise  sum over readings of (measured - reading(q))^2 in mm^2.
/// A chain is as long as the distance of its ends and the excess over that which it has in the simulation of the same row. Where bones form
/// a loop, the distances at the ball joint that closes it are readings that are 0.
/// The search begins at the pose of the row asked for before. A value that is missing in a row keeps that of the last row with one.
/// Source: Nocedal & Wright, Numerical Optimization, Ch. 10.
class MeasuredPoses {
 public:
  /// Builds a robot of its own, as a replay with these options does, but without effects of the options. `recording` must outlive it.
  /// Throws as replayRecording for the model.
  MeasuredPoses(const Recording& recording, const ReplayOptions& options);
  ~MeasuredPoses();
  MeasuredPoses(const MeasuredPoses&) = delete;
  MeasuredPoses& operator=(const MeasuredPoses&) = delete;

  /// Whether what is measured determines the pose.
  bool areDetermined() const;
  /// From what the poses follow ("from the joint angles"), or why there are none.
  const std::string& reason() const;
  /// The pose in a row; null if the poses are not determined. `simulated`: of the same row.
  std::shared_ptr<const DrawnGhost> at(std::size_t row, const Snapshot& simulated);
  /// Signals of motion near the pose measured in a row. Chains count as straight. Nothing if the pose is not determined, if bones form a
  /// loop, or if a signal is none of this robot's angles, muscle lengths and coordinates of the hand.
  std::optional<MotionExpansion> expansion(std::size_t row, const std::vector<std::string>& signals);

 private:
  class Search;
  std::unique_ptr<Search> search_;
  std::string reason_;
};

}  // namespace musclesim
