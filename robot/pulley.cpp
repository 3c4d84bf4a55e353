#include "musclesim/robot/pulley.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace musclesim {

namespace {

constexpr double surface_depth_ratio = 1e-6;               ///< of the radius; points up to this depth count as points on the surface
constexpr double parallel_sine = 1e-12;                    ///< below this the plane of two directions is lost in rounding errors
constexpr double drawn_angle_rad = std::numbers::pi / 12;  ///< of the arc between two drawn points

/// v without its part along a unit vector (which may be zero).
Vector across(const Vector& v, const Vector& axis) {
  return v - axis.dot(v) * axis;
}

/// Normal of the plane through a sphere's centre and two points; turning from a to b about it is right-handed. Where a, b and the centre
/// lie on a line, any plane through them will do, best the one of the side point.
Vector planeNormal(const Vector& a, const Vector& b, const std::optional<Vector>& side) {
  const Vector normal = a.cross(b);
  const double size = normal.norm();
  if (size > parallel_sine * a.norm() * b.norm()) return normal / size;
  if (side && a.cross(*side).norm() > parallel_sine * a.norm() * side->norm()) return a.cross(*side).normalized();
  return a.unitOrthogonal();
}

/// The quantities of wayPast, from the pulley's centre.
struct Winding {
  bool exists = false;  ///< otherwise the way is straight
  Vector n, a, b;
  double height_mm = 0, start_height_mm = 0;  ///< from a to b, and of a over the centre
  double sense = 0;                           ///< s
  double k_a_mm = 0, k_b_mm = 0;
  double arc_rad = 0;  ///< theta
  double radius_mm = 0;

  double acrossMm() const { return k_a_mm + radius_mm * arc_rad + k_b_mm; }
  /// Directions of the thread across the axis, at a and b.
  Vector startAcross() const { return (sense * radius_mm * n.cross(a) - k_a_mm * a) / a.squaredNorm(); }
  Vector endAcross() const { return (sense * radius_mm * n.cross(b) + k_b_mm * b) / b.squaredNorm(); }
};

/// The point of the segment from a to b that is nearest to the origin.
Vector nearestPoint(const Vector& a, const Vector& b) {
  const Vector along = b - a;
  const double length_squared = along.squaredNorm();
  return length_squared > 0 ? Vector(a + std::clamp(-a.dot(along) / length_squared, 0.0, 1.0) * along) : a;
}

/// Whether a thread with a side point passes where the straight segment does.
bool passesWithSegment(const Winding& w, const Vector& side) {
  if (!w.exists) return side.dot(nearestPoint(w.a, w.b)) >= 0;
  return w.sense * side.dot(w.n.cross(w.a.normalized() - w.b.normalized())) >= 0;
}

Winding windingOf(const Pulley& pulley, const Vector& from_mm, const Vector& to_mm) {
  Winding w;
  const Vector start = from_mm - pulley.center_mm, end = to_mm - pulley.center_mm;
  const std::optional<Vector> side = pulley.side_mm ? std::optional<Vector>(*pulley.side_mm - pulley.center_mm) : std::nullopt;
  const double r = w.radius_mm = pulley.radius_mm;
  w.a = across(start, pulley.axis);
  w.b = across(end, pulley.axis);
  const double a_squared = w.a.squaredNorm(), b_squared = w.b.squaredNorm();
  if (std::min(a_squared, b_squared) < std::pow(r * (1 - surface_depth_ratio), 2)) return w;

  w.n = pulley.axis.isZero(0) ? planeNormal(w.a, w.b, side) : pulley.axis;
  w.start_height_mm = w.n.dot(start);
  w.height_mm = w.n.dot(end) - w.start_height_mm;
  w.k_a_mm = std::sqrt(std::max(0.0, a_squared - r * r));
  w.k_b_mm = std::sqrt(std::max(0.0, b_squared - r * r));
  // The arguments of the factors are delta, -phi_a and -phi_b.
  const double cosine = w.a.dot(w.b), sine = w.n.dot(w.a.cross(w.b));
  const std::complex<double> tangents = std::complex(r, -w.k_a_mm) * std::complex(r, -w.k_b_mm);
  w.sense = sine >= 0 ? 1 : -1;
  w.arc_rad = std::arg(std::complex(cosine, std::abs(sine)) * tangents);
  w.exists = w.arc_rad > 0;
  if (side && !passesWithSegment(w, *side)) {
    w.exists = true;
    w.sense = -w.sense;
    w.arc_rad = std::arg(std::complex(cosine, -std::abs(sine)) * tangents);
    if (w.arc_rad <= 0) w.arc_rad += 2 * std::numbers::pi;
  }
  return w;
}

}  // namespace

double Pulley::distanceMm(const Vector& point_mm) const {
  return across(point_mm - center_mm, axis).norm();
}

bool Pulley::encloses(const Vector& point_mm) const {
  return distanceMm(point_mm) < radius_mm * (1 - surface_depth_ratio);
}

Way straightWay(const Vector& from_mm, const Vector& to_mm) {
  Vector direction = to_mm - from_mm;
  const double length_mm = direction.norm();
  if (length_mm > 0) direction /= length_mm;
  return {length_mm, direction, direction};
}

Way wayPast(const Pulley& pulley, const Vector& from_mm, const Vector& to_mm) {
  const Winding w = windingOf(pulley, from_mm, to_mm);
  if (!w.exists) return straightWay(from_mm, to_mm);
  const double across_mm = w.acrossMm(), length_mm = std::hypot(across_mm, w.height_mm);
  const double share = across_mm / length_mm;
  const Vector climb = w.height_mm / length_mm * w.n;
  return {length_mm, share * w.startAcross() + climb, share * w.endAcross() + climb, true};
}

std::vector<Vector> pointsOnPulleyMm(const Pulley& pulley, const Vector& from_mm, const Vector& to_mm) {
  const Winding w = windingOf(pulley, from_mm, to_mm);
  if (!w.exists) return {};
  const Vector first = w.a + w.k_a_mm * w.startAcross();  // the first tangent point, across the axis
  const Vector turned = w.sense * w.n.cross(first);       // the same a quarter of a turn later
  const int count = 1 + static_cast<int>(std::ceil(w.arc_rad / drawn_angle_rad));
  std::vector<Vector> points;
  for (int i = 0; i <= count; ++i) {
    const double angle = w.arc_rad * i / count;
    const double height_mm = w.start_height_mm + w.height_mm * (w.k_a_mm + w.radius_mm * angle) / w.acrossMm();
    points.push_back(pulley.center_mm + std::cos(angle) * first + std::sin(angle) * turned + height_mm * w.n);
  }
  return points;
}

}  // namespace musclesim
