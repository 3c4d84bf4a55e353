/// Unit quaternions (w, x, y, z) as ODE uses them.
#pragma once

#include <Eigen/Core>

namespace musclesim::chain {

using Quaternion = Eigen::Vector4d;

inline Quaternion conjugate(const Quaternion& a) {
  return {a[0], -a[1], -a[2], -a[3]};
}

inline Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

/// Rotation matrix of a unit quaternion.
inline Eigen::Matrix3d matrixOf(const Quaternion& a) {
  const double w = a[0], x = a[1], y = a[2], z = a[3];
  Eigen::Matrix3d r;
  r << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  return r;
}

}  // namespace musclesim::chain
