/// All bodies of the chain stepper in contiguous memory. They are read from ODE before a step and written back after it.
#pragma once

#include <ode/ode.h>

#include <Eigen/Core>
#include <Eigen/StdVector>
#include <vector>

#include "musclesim/simulation/stepper.h"
#include "quaternion.h"

namespace musclesim::chain {

using Vector = Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Pose, motion and external load of one body, world frame.
struct BodyMotion {
  Vector position;           ///< centre of mass, mm
  Quaternion quaternion;     ///< orientation
  Eigen::Matrix3d rotation;  ///< orientation as a matrix whose columns are the body's axes
  Vector velocity;           ///< mm/s
  Vector spin;               ///< angular velocity, rad/s
  Vector force;              ///< g mm/s^2
  Vector torque;             ///< about the centre of mass, g mm^2/s^2
};

class BodyState {
 public:
  BodyState() { clear(); }
  void clear();
  int add(dBodyID id);
  /// Number of bodies, the environment not counted.
  int count() const { return static_cast<int>(ids_.size()); }
  dBodyID id(int body) const { return ids_[static_cast<std::size_t>(body)]; }
  /// Body -1 is the environment: it is at rest in the world frame.
  BodyMotion& operator[](int body) { return motions_[static_cast<std::size_t>(body + 1)]; }
  const BodyMotion& operator[](int body) const { return motions_[static_cast<std::size_t>(body + 1)]; }
  /// Index of a body, or -1 if it was never added. Valid after sort().
  int find(dBodyID id) const;
  void sort();

  /// Reads pose, velocities and the forces accumulated on ODE's bodies.
  void gather();
  /// Moves all bodies by one step as ODE does. u (6 numbers per body) is the new velocity divided by h:
  ///     v+ = h u,  x+ = x + h v+,  q+ = normalised(q + h/2 (0, w+) q).
  /// Throws BodyOutOfBounds, with ODE's bodies unchanged, if a body leaves the bounds.
  void integrate(double h_s, const std::vector<Vector6>& u, const BodyBounds& bounds);
  /// Writes pose and velocities to ODE's bodies and clears their accumulators.
  void scatter() const;

 private:
  struct Entry {
    dBodyID id;
    int body;
  };
  std::vector<dBodyID> ids_;
  std::vector<BodyMotion> motions_;
  std::vector<Entry> sorted_;
};

}  // namespace musclesim::chain
