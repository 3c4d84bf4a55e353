/// Mass, centre of mass and inertia of rigid bodies: of solids, moved to other frames, added up.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "source_shape.h"

namespace musclesim {

/// Mass properties of a rigid body in some frame of the body, in kg and m.
struct MassProperties {
  double mass_kg = 0;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();  ///< about the centre of mass, along the axes of the frame

  /// The same body seen from a frame in which the present frame has the given pose.
  MassProperties seenFrom(const Pose& pose) const;
  /// Adds another body to this one; both are in the same frame (parallel axis theorem).
  void add(const MassProperties& other);
  /// The body with its mass and inertia times a factor.
  MassProperties scaled(double factor) const;
};

/// The three principal moments, ascending, and the axes to which they belong, a right-handed frame.
struct PrincipalInertia {
  Eigen::Vector3d moments_kg_m2;
  Eigen::Matrix3d axes;
};
PrincipalInertia principalInertia(const Eigen::Matrix3d& inertia_kg_m2);

/// Volume of a shape, m^3.
double volumeM3(const SourceShape& shape);

/// A solid of this shape and of even density in the frame in which the shape has its pose.
MassProperties solid(const SourceShape& shape, double mass_kg);

/// The least moment that must be added about every axis so that a body can have this inertia: no principal moment is greater than the sum
/// of the other two. 0 if it can have it as it is.
double missingInertia(const Eigen::Matrix3d& inertia_kg_m2);

/// The box of even density with this mass and inertia, at the centre of mass along the principal axes. No value if a box cannot have them.
std::optional<SourceShape> equivalentBox(const MassProperties& mass);

}  // namespace musclesim
