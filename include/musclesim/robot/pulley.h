/// Pulleys, and the way of a taut thread around one.
#pragma once

#include <optional>
#include <vector>

#include "musclesim/robot/state.h"

namespace musclesim {

/// A frictionless cylinder without ends, or a sphere, that a thread may lie on. All vectors are in one frame.
struct Pulley {
  Vector center_mm;  ///< of the sphere, or a point on the cylinder's axis
  Vector axis;       ///< of unit length; zero: a sphere
  double radius_mm;
  std::optional<Vector> side_mm;  ///< the thread passes on the side of this point

  /// Distance of a point from the axis, or from the sphere's centre.
  double distanceMm(const Vector& point_mm) const;
  /// Whether a point lies inside. Points deeper than the surface by no more than a millionth of the radius count as points on it, so that
  /// ends that are fixed to the surface stay there under rounding and joint errors.
  bool encloses(const Vector& point_mm) const;
};

/// The way of a taut thread from a point to another.
struct Way {
  double length_mm;
  Vector start_direction;  ///< of the thread at its first point; dl/d(first point) = -start_direction
  Vector end_direction;    ///< of the thread at its last point; dl/d(last point) = end_direction
  bool wound = false;      ///< whether it lies on a pulley
};

Way straightWay(const Vector& from_mm, const Vector& to_mm);

/// The way past a pulley: straight, or a tangent from each point and the shortest line on the surface between them.
///
/// Across the axis n (of a sphere: the normal of the plane through both points and the centre), from the centre to the points a and b:
///     theta = delta - phi_a - phi_b,   phi_x = arccos(r / |x|),   k_x = sqrt(|x|^2 - r^2)
///     p = k_a + r theta + k_b,   l = sqrt(p^2 + h^2)
///     u_a = (s r n x a - k_a a) / |a|^2,   u_b = (s r n x b + k_b b) / |b|^2
///     start direction (p u_a + h n) / l,   end direction (p u_b + h n) / l
/// delta angle from a to b on the side where the thread passes, theta angle of the arc, phi between a point and its tangent point, k the
/// tangents' lengths in mm, r the radius, p the length across the axis, h the height from a to b along n (0 for a sphere), which grows in
/// proportion to the length across the axis: unrolled, the way is a straight line. u are the directions across the axis; s = 1 if the
/// thread turns right-handed about n, otherwise -1.
/// The straight segment passes on the side where delta <= 180 degrees, and touches if theta > 0 there. Without a side point y the thread
/// passes on this side. With one: if the segment does not touch and y . m >= 0, m its point nearest to the axis, the way is straight; if
/// it does not touch and y . m < 0, the thread passes on the other side; if it touches, the thread takes the arc whose middle is nearer to
/// y, s = sign of y . (n x (a/|a| - b/|b|)). The way is also straight if a point lies inside the pulley.
/// The choice depends on the pose only. So the length jumps where the side changes; a side point on the side where the thread always
/// passes avoids this. Source of the side point: the "side sites" of the simulator MuJoCo, XML reference, spatial tendons. MuJoCo 2.2.2
/// gives the same lengths but in two cases: where one of the two arcs is longer than 180 degrees it may choose the other one, and where the
/// side point of a sphere is nearer to the centre than r across the normal it leads the thread through the inside.
Way wayPast(const Pulley& pulley, const Vector& from_mm, const Vector& to_mm);

/// Points of that way on the pulley, for drawing: both tangent points and at least one every 15 degrees between them; none if it is
/// straight.
std::vector<Vector> pointsOnPulleyMm(const Pulley& pulley, const Vector& from_mm, const Vector& to_mm);

}  // namespace musclesim
