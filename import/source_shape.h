/// Solid shapes of the robots that are imported, in the frames and units of the source: z up, m.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>

namespace musclesim {

/// Where a frame lies in another: a rotation and a translation in m.
using Pose = Eigen::Isometry3d;

/// The least rotation that turns the z axis into a direction.
inline Eigen::Matrix3d turnOfZAxis(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), to = direction.normalized(), axis = z.cross(to);
  const double sine = axis.norm();
  constexpr double parallel = 1e-10;  // sine
  const Eigen::Vector3d about = sine < parallel ? Eigen::Vector3d(Eigen::Vector3d::UnitX()) : Eigen::Vector3d(axis / sine);
  return Eigen::AngleAxisd(std::atan2(sine, to.z()), about).toRotationMatrix();
}

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
