#include "musclesim/robot/pulley.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
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

using Planar = Eigen::Vector2d;

/// v turned by 90 degrees.
Planar quarterTurn(const Planar& v) {
  return {-v.y(), v.x()};
}

/// A pulley's axis n and two directions across it, x, y, n right-handed.
struct Frame {
  Vector n, x, y;

  explicit Frame(const Vector& axis) : n(axis), x(n.unitOrthogonal()), y(n.cross(x)) {}
  Planar across(const Vector& v) const { return {x.dot(v), y.dot(v)}; }
  Vector outOf(const Planar& v) const { return v.x() * x + v.y() * y; }
};

/// The quantities of wayPast, from the pulley's centre, and across the axis in two dimensions.
struct Winding {
  bool exists = false;  ///< otherwise the way is straight
  Planar a, b;
  double height_mm = 0, start_height_mm = 0;  ///< from a to b, and of a over the centre
  double sense = 0;                           ///< s
  double k_a_mm = 0, k_b_mm = 0;
  double arc_rad = 0;  ///< theta
  double radius_mm = 0;

  double acrossMm() const { return k_a_mm + radius_mm * arc_rad + k_b_mm; }
  /// Directions of the thread across the axis, at a and b.
  Planar startAcross() const { return (sense * radius_mm * quarterTurn(a) - k_a_mm * a) / a.squaredNorm(); }
  Planar endAcross() const { return (sense * radius_mm * quarterTurn(b) + k_b_mm * b) / b.squaredNorm(); }
};

/// The point of the segment from a to b that is nearest to the origin.
Planar nearestPoint(const Planar& a, const Planar& b) {
  const Planar along = b - a;
  const double length_squared = along.squaredNorm();
  return length_squared > 0 ? Planar(a + std::clamp(-a.dot(along) / length_squared, 0.0, 1.0) * along) : a;
}

/// Whether a thread with a side point passes where the straight segment does.
bool passesWithSegment(const Winding& w, const Planar& side) {
  if (!w.exists) return side.dot(nearestPoint(w.a, w.b)) >= 0;
  return w.sense * side.dot(quarterTurn(w.b.norm() * w.a - w.a.norm() * w.b)) >= 0;
}

/// The angle of (x, y), -pi .. pi. To a unit of the last digit that of std::atan2, at half its cost: the step of a muscle with a pulley
/// spends a large part of its time here.
double angleOf(double x, double y) {
  constexpr double quarter_rad = std::numbers::pi / 2;
  if (std::abs(y) > std::abs(x)) return std::copysign(quarter_rad, y) - std::atan(x / y);
  const double angle_rad = x == 0 ? 0 : std::atan(y / x);
  return x < 0 ? angle_rad + std::copysign(2 * quarter_rad, y) : angle_rad;
}

/// The angle of (x, y) (u, v), both taken as complex numbers.
double angleOfProduct(double x, double y, double u, double v) {
  return angleOf(x * u - y * v, x * v + y * u);
}

Frame frameOf(const Pulley& pulley, const Vector& start, const Vector& end) {
  if (!pulley.axis.isZero(0)) return Frame(pulley.axis);
  return Frame(planeNormal(start, end, pulley.side_mm ? std::optional<Vector>(*pulley.side_mm - pulley.center_mm) : std::nullopt));
}

/// `start` and `end` from the pulley's centre.
Winding windingOf(const Pulley& pulley, const Frame& frame, const Vector& start, const Vector& end) {
  Winding w;
  const double r = w.radius_mm = pulley.radius_mm, least_mm = r * (1 - surface_depth_ratio);
  w.a = frame.across(start);
  w.b = frame.across(end);
  const double a_squared = w.a.squaredNorm(), b_squared = w.b.squaredNorm();
  if (!(std::min(a_squared, b_squared) >= least_mm * least_mm)) return w;  // also for a sphere about the start, which has no frame

  w.start_height_mm = frame.n.dot(start);
  w.height_mm = frame.n.dot(end) - w.start_height_mm;
  w.k_a_mm = std::sqrt(std::max(0.0, a_squared - r * r));
  w.k_b_mm = std::sqrt(std::max(0.0, b_squared - r * r));
  // (cosine, sine) stands at the angle delta, (r, -k_a) at -phi_a, (r, -k_b) at -phi_b; these two make the tangents.
  const double cosine = w.a.dot(w.b), sine = quarterTurn(w.a).dot(w.b);
  const double tangents_x = r * r - w.k_a_mm * w.k_b_mm, tangents_y = -r * (w.k_a_mm + w.k_b_mm);
  w.sense = sine >= 0 ? 1 : -1;
  w.arc_rad = angleOfProduct(cosine, std::abs(sine), tangents_x, tangents_y);
  w.exists = w.arc_rad > 0;
  if (pulley.side_mm && !passesWithSegment(w, frame.across(*pulley.side_mm - pulley.center_mm))) {
    w.exists = true;
    w.sense = -w.sense;
    w.arc_rad = angleOfProduct(cosine, -std::abs(sine), tangents_x, tangents_y);
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
  const Vector start = from_mm - pulley.center_mm, end = to_mm - pulley.center_mm;
  const Frame frame = frameOf(pulley, start, end);
  const Winding w = windingOf(pulley, frame, start, end);
  if (!w.exists) return straightWay(from_mm, to_mm);
  const double across_mm = w.acrossMm(), length_mm = std::sqrt(across_mm * across_mm + w.height_mm * w.height_mm);
  const double share = across_mm / length_mm;
  const Vector climb = w.height_mm / length_mm * frame.n;
  return {length_mm, frame.outOf(share * w.startAcross()) + climb, frame.outOf(share * w.endAcross()) + climb, true};
}

std::vector<Vector> pointsOnPulleyMm(const Pulley& pulley, const Vector& from_mm, const Vector& to_mm) {
  const Vector start = from_mm - pulley.center_mm, end = to_mm - pulley.center_mm;
  const Frame frame = frameOf(pulley, start, end);
  const Winding w = windingOf(pulley, frame, start, end);
  if (!w.exists) return {};
  const Planar first = w.a + w.k_a_mm * w.startAcross();  // the first tangent point, across the axis
  const Planar turned = w.sense * quarterTurn(first);     // the same a quarter of a turn later
  const int count = 1 + static_cast<int>(std::ceil(w.arc_rad / drawn_angle_rad));
  std::vector<Vector> points;
  for (int i = 0; i <= count; ++i) {
    const double angle = w.arc_rad * i / count;
    const double height_mm = w.start_height_mm + w.height_mm * (w.k_a_mm + w.radius_mm * angle) / w.acrossMm();
    points.push_back(pulley.center_mm + frame.outOf(std::cos(angle) * first + std::sin(angle) * turned) + height_mm * frame.n);
  }
  return points;
}

}  // namespace musclesim
