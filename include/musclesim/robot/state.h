/// A robot's readings (its state) and commands (its action).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace musclesim {

/// A point or direction in the world frame: right-handed, x to the side, y up, z to the front; points are in mm.
using Vector = Eigen::Vector3d;

/// Commanded pressure of every muscle, fraction of full scale 0..1, in the order of the muscles.
using Action = std::vector<double>;

/// The readings of a robot at one time. Vectors have one entry per muscle or per named joint, in the robot's order.
struct State {
  double time_s = 0.0;
  std::vector<double> command;    ///< fraction of full scale
  std::vector<double> pressure;   ///< fraction of full scale
  std::vector<double> force_N;    ///< tension, pulling positive
  std::vector<double> length_mm;  ///< muscle lengths
  std::vector<double> angle_deg;  ///< named joints
  std::optional<Vector> hand_mm;  ///< the point that the robot reports as its hand
};

}  // namespace musclesim
