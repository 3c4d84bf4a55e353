/// Solid shapes of the robots that are imported, in the frames and units of the source: z up, m.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

namespace musclesim {

/// Where a frame lies in another: a rotation and a translation in m.
using Pose = Eigen::Isometry3d;

struct SourceShape {
  enum class Kind { box, sphere, capsule, cylinder, ellipsoid };
  Kind kind = Kind::sphere;
  /// Box: edges; sphere: radius, 0, 0; capsule and cylinder, along z: radius, length (of capsules without the caps), 0; ellipsoid: half
  /// axes.
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  Pose pose = Pose::Identity();  ///< in the frame of the body
  std::optional<std::array<double, 3>> color = {};
};

}  // namespace musclesim
