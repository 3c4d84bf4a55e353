#include "musclesim/robot/line_of_pull.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/muscle_settings.h"
#include "musclesim/robot/physics.h"
#include "musclesim/robot/primitive.h"
#include "ode_vector.h"
#include "vector_checks.h"

namespace musclesim {

namespace {

constexpr double dry_speed_mm_per_s = 100;      ///< at this speed dry friction has 76 % of its full force
constexpr double stop_stiffness_N_per_mm = 10;  ///< of the spring beyond the longest length

/// Speed in world units over true speed. In `original`, forces are too small by a factor, and speeds by its square root.
double speedRatio(const PhysicsSettings& physics) {
  return std::sqrt(physics.force_per_N / world_force_per_N);
}

}  // namespace

LineOfPull::LineOfPull(const Vector& start_mm, const Vector& end_mm)
    : points_{{nullptr, start_mm, false}, {nullptr, end_mm, false}}, pulleys_(1) {}

LineOfPull::Point LineOfPull::pointOn(Primitive* primitive, const Vector& point_mm) {
  if (!primitive) return {nullptr, point_mm, true};
  primitive->body().has_joint = true;  // from now on its body must not be merged into another body
  const dBodyID body = primitive->body().id;
  return {body, rotationOf(body).transpose() * (point_mm - positionOf(body)), true};
}

void LineOfPull::connect(End end, Primitive* primitive, const std::string& muscle_name) {
  Point& point = end == End::start ? points_.front() : points_.back();
  if (point.connected)
    throw BadParameter(std::string("the ") + (end == End::start ? "start" : "end") + " of " + muscle_name + " is already connected");
  point = pointOn(primitive, point.place);
  forgetPoses();
}

void LineOfPull::addViaPoint(Primitive* primitive, const Vector& point_mm) {
  points_.insert(points_.end() - 1, pointOn(primitive, point_mm));
  pulleys_.emplace_back();
  forgetPoses();
}

void LineOfPull::addPulley(Primitive* primitive, Pulley pulley, const std::string& muscle_name) {
  const std::string name = "pulley of " + muscle_name;
  requireFinite(name + ": center", pulley.center_mm);
  requireFinite(name + ": axis", pulley.axis);
  if (!(pulley.radius_mm > 0 && std::isfinite(pulley.radius_mm)))
    throw BadParameter(name + ": radius", fmt::format("{} mm", pulley.radius_mm), "be positive and finite");
  if (!pulley.axis.isZero(0)) pulley.axis.normalize();
  if (pulley.side_mm) {
    requireFinite(name + ": side point", *pulley.side_mm);
    const double distance_mm = pulley.distanceMm(*pulley.side_mm);
    if (distance_mm < pulley.radius_mm)
      throw BadParameter(name + ": distance of its side point", fmt::format("{:.4g} mm", distance_mm),
                         fmt::format("be at least its radius, {} mm", pulley.radius_mm));
  }
  if (pulleys_.back()) throw BadParameter("two pulleys of " + muscle_name + " in a row: there must be a via point between them");
  const Point center = pointOn(primitive, pulley.center_mm);
  pulley.center_mm = center.place;
  if (center.body) {
    pulley.axis = rotationOf(center.body).transpose() * pulley.axis;
    if (pulley.side_mm) pulley.side_mm = pointOn(primitive, *pulley.side_mm).place;
  }
  pulleys_.back() = MountedPulley{center.body, pulley};
  forgetPoses();
}

void LineOfPull::setTendonMm(double tendon_mm, const std::string& muscle_name) {
  if (!(tendon_mm >= 0 && std::isfinite(tendon_mm)))
    throw BadParameter("tendon of " + muscle_name, fmt::format("{} mm", tendon_mm), "be finite and at least 0 mm");
  tendon_mm_ = tendon_mm;
  forgetPoses();
}

void LineOfPull::moveCenter(dBodyID body, const Vector& shift_mm) {
  for (Point& point : points_)
    if (point.body == body) point.place -= shift_mm;
  for (auto& mounted : pulleys_) {
    if (!mounted || mounted->body != body) continue;
    mounted->pulley.center_mm -= shift_mm;
    if (mounted->pulley.side_mm) *mounted->pulley.side_mm -= shift_mm;
  }
  forgetPoses();
}

Vector LineOfPull::worldPosition(const Point& point) {
  if (!point.body) return point.place;
  return positionOf(point.body) + turned(point.place, dBodyGetRotation(point.body));
}

Pulley LineOfPull::inWorld(const MountedPulley& mounted) {
  Pulley pulley = mounted.pulley;
  if (!mounted.body) return pulley;
  const dReal* rotation = dBodyGetRotation(mounted.body);
  const Vector position = positionOf(mounted.body);
  pulley.center_mm = position + turned(pulley.center_mm, rotation);
  pulley.axis = turned(pulley.axis, rotation);
  if (pulley.side_mm) pulley.side_mm = position + turned(*pulley.side_mm, rotation);
  return pulley;
}

std::vector<Pulley> LineOfPull::pulleys() const {
  std::vector<Pulley> all;
  for (const auto& mounted : pulleys_)
    if (mounted) all.push_back(inWorld(*mounted));
  return all;
}

void LineOfPull::requirePointsOutside(const std::string& muscle_name) const {
  for (std::size_t i = 0; i < pulleys_.size(); ++i) {
    if (!pulleys_[i]) continue;
    const Pulley pulley = inWorld(*pulleys_[i]);
    for (const std::size_t neighbour : {i, i + 1}) {
      const Vector point = worldPosition(points_[neighbour]);
      if (pulley.encloses(point))
        throw BadParameter(fmt::format("distance of point {} of {} from the pulley beside it", neighbour, muscle_name),
                           fmt::format("{:.4g} mm", pulley.distanceMm(point)),
                           fmt::format("be at least the radius, {} mm", pulley.radius_mm));
    }
  }
}

void LineOfPull::forgetPoses() {
  poses_.clear();
  is_located_ = false;
  const auto add = [this](dBodyID body) {
    if (body && std::ranges::find(poses_, body, &Pose::body) == poses_.end()) poses_.push_back({body, {}, {}});
  };
  for (const Point& point : points_) add(point.body);
  for (const auto& mounted : pulleys_)
    if (mounted) add(mounted->body);
}

bool LineOfPull::haveBodiesMoved() const {
  bool moved = !is_located_;
  is_located_ = true;
  for (Pose& pose : poses_) {
    const dReal *position = dBodyGetPosition(pose.body), *quaternion = dBodyGetQuaternion(pose.body);
    if (std::ranges::equal(pose.position_mm, std::span(position, 3)) && std::ranges::equal(pose.quaternion, std::span(quaternion, 4)))
      continue;
    std::copy_n(position, 3, pose.position_mm.begin());
    std::copy_n(quaternion, 4, pose.quaternion.begin());
    moved = true;
  }
  return moved;
}

/// dl/dx of the points; that of a pulley is the opposite of those of its two points.
void LineOfPull::locate() const {
  if (!haveBodiesMoved()) return;
  pushes_.clear();
  length_mm_ = -tendon_mm_;
  Vector here = worldPosition(points_.front()), gradient = Vector::Zero();
  for (std::size_t i = 0; i < pulleys_.size(); ++i) {
    const Vector next = worldPosition(points_[i + 1]);
    const auto& mounted = pulleys_[i];
    const Way way = mounted ? wayPast(inWorld(*mounted), here, next) : straightWay(here, next);
    length_mm_ += way.length_mm;
    addPush(points_[i].body, here, gradient - way.start_direction);
    if (way.wound && mounted->body) {
      const Vector center = positionOf(mounted->body), &d = way.start_direction, &e = way.end_direction;
      pushes_.push_back({mounted->body, d - e, (here - center).cross(d) - (next - center).cross(e)});
    }
    here = next;
    gradient = way.end_direction;
  }
  addPush(points_.back().body, here, gradient);
}

void LineOfPull::addPush(dBodyID body, const Vector& position, const Vector& gradient) const {
  if (body) pushes_.push_back({body, gradient, (position - positionOf(body)).cross(gradient)});
}

double LineOfPull::lengthMm() const {
  locate();
  return length_mm_;
}

std::vector<Vector> LineOfPull::pointsMm() const {
  std::vector<Vector> result = {worldPosition(points_.front())};
  for (std::size_t i = 0; i < pulleys_.size(); ++i) {
    const Vector next = worldPosition(points_[i + 1]);
    if (pulleys_[i]) std::ranges::copy(pointsOnPulleyMm(inWorld(*pulleys_[i]), result.back(), next), std::back_inserter(result));
    result.push_back(next);
  }
  return result;
}

std::vector<LineOfPull::Push> LineOfPull::pushes() const {
  locate();
  return pushes_;
}

double LineOfPull::speed() const {
  double sum = 0;
  for (const auto& [body, force, torque] : pushes_)
    sum += force.dot(fromOde(dBodyGetLinearVel(body))) + torque.dot(fromOde(dBodyGetAngularVel(body)));
  return sum;
}

double LineOfPull::totalForceN(double tension_N, double maximum_length_mm, const MuscleSettings& settings,
                               const PhysicsSettings& physics) const {
  return tension_N + frictionN(speed() / speedRatio(physics), settings) + stopN(length_mm_, maximum_length_mm);
}

double LineOfPull::frictionN(double speed_mm_per_s, const MuscleSettings& settings) {
  return settings.slider_friction_N *
         (settings.viscous ? speed_mm_per_s / settings.slider_viscous_speed_mm_per_s : std::tanh(speed_mm_per_s / dry_speed_mm_per_s));
}

double LineOfPull::stopN(double length_mm, double maximum_length_mm) {
  const double excess_mm = length_mm - maximum_length_mm;
  return excess_mm > 0 ? stop_stiffness_N_per_mm * excess_mm : 0;
}

void LineOfPull::pull(double tension_N, double maximum_length_mm, const MuscleSettings& settings, const PhysicsSettings& physics) const {
  if (!isConnected()) return;
  const double force = totalForceN(tension_N, maximum_length_mm, settings, physics) * physics.force_per_N;
  for (const Push& push : pushes_) {
    const Vector f = -force * push.force, t = -force * push.torque;
    dBodyAddForce(push.body, f.x(), f.y(), f.z());
    dBodyAddTorque(push.body, t.x(), t.y(), t.z());
  }
}

double LineOfPull::stiffnessNPerMm(double of_tension_N_per_mm) {
  return of_tension_N_per_mm + stop_stiffness_N_per_mm;
}

double LineOfPull::dampingNsPerMm(const MuscleSettings& settings) {
  return settings.slider_friction_N / (settings.viscous ? settings.slider_viscous_speed_mm_per_s : dry_speed_mm_per_s);
}

}  // namespace musclesim
