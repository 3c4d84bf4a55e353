/// Conversions between ODE's arrays and Eigen's types.
#pragma once

#include <ode/ode.h>

#include <Eigen/Core>

namespace musclesim {

inline Eigen::Vector3d fromOde(const dReal* v) {
  return {v[0], v[1], v[2]};
}

/// ODE stores 3x3 matrices in rows of four.
inline Eigen::Matrix3d matrixFromOde(const dReal* m) {
  Eigen::Matrix3d result;
  result << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  return result;
}

/// R v
inline Eigen::Vector3d turned(const Eigen::Vector3d& v, const dReal* r) {
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[4] * v[0] + r[5] * v[1] + r[6] * v[2], r[8] * v[0] + r[9] * v[1] + r[10] * v[2]};
}

inline Eigen::Vector3d positionOf(dBodyID body) {
  return fromOde(dBodyGetPosition(body));
}

inline Eigen::Matrix3d rotationOf(dBodyID body) {
  return matrixFromOde(dBodyGetRotation(body));
}

inline void setRotation(dBodyID body, const Eigen::Matrix3d& rotation) {
  dMatrix3 m = {rotation(0, 0), rotation(0, 1), rotation(0, 2), 0, rotation(1, 0), rotation(1, 1), rotation(1, 2), 0,
                rotation(2, 0), rotation(2, 1), rotation(2, 2), 0};
  dBodySetRotation(body, m);
}

}  // namespace musclesim
