#include "musclesim/robot/line_of_pull.h"

#include <Eigen/Geometry>
#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/muscle_settings.h"
#include "musclesim/robot/physics.h"
#include "musclesim/robot/primitive.h"
#include "ode_vector.h"

namespace musclesim {

namespace {

constexpr double dry_speed_mm_per_s = 100;      ///< at this speed dry friction has 76 % of its full force
constexpr double stop_stiffness_N_per_mm = 10;  ///< of the spring beyond the longest length

/// Speed in world units over true speed. In `original`, forces are too small by a factor, and speeds by its square root.
double speedRatio(const PhysicsSettings& physics) {
  return std::sqrt(physics.force_per_N / world_force_per_N);
}

}  // namespace

LineOfPull::LineOfPull(const Vector& start_mm, const Vector& end_mm) : points_{{nullptr, start_mm, false}, {nullptr, end_mm, false}} {}

LineOfPull::Point LineOfPull::pointOn(Primitive* primitive, const Vector& point_mm) {
  if (!primitive) return {nullptr, point_mm, true};
  primitive->body().has_joint = true;  // from now on its body must not be merged into another body
  const dBodyID body = primitive->body().id;
  return {body, rotationOf(body).transpose() * (point_mm - musclesim::positionOf(body)), true};
}

void LineOfPull::connect(End end, Primitive* primitive, const std::string& muscle_name) {
  Point& point = end == End::start ? points_.front() : points_.back();
  if (point.connected)
    throw BadParameter(std::string("the ") + (end == End::start ? "start" : "end") + " of " + muscle_name + " is already connected");
  point = pointOn(primitive, point.place);
}

void LineOfPull::addViaPoint(Primitive* primitive, const Vector& point_mm) {
  points_.insert(points_.end() - 1, pointOn(primitive, point_mm));
}

void LineOfPull::recentre(dBodyID body, const Vector& by_mm) {
  for (Point& point : points_)
    if (point.body == body) point.place -= by_mm;
}

void LineOfPull::locate() const {
  located_.resize(points_.size());
  length_mm_ = 0;
  Located* before = nullptr;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& point = points_[i];
    Located& here = located_[i];
    here.arm = point.body ? turned(point.place, dBodyGetRotation(point.body)) : point.place;
    here.position = point.body ? Vector(musclesim::positionOf(point.body) + here.arm) : point.place;
    here.gradient.setZero();
    if (before) {
      Vector direction = here.position - before->position;
      const double segment_mm = direction.norm();
      if (segment_mm > 0) direction /= segment_mm;
      before->gradient -= direction;
      here.gradient = direction;
      length_mm_ += segment_mm;
    }
    before = &here;
  }
}

double LineOfPull::lengthMm() const {
  locate();
  return length_mm_;
}

std::vector<Vector> LineOfPull::pointsMm() const {
  locate();
  std::vector<Vector> result;
  for (const Located& point : located_) result.push_back(point.position);
  return result;
}

double LineOfPull::speed() const {
  double sum = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const dBodyID body = points_[i].body;
    if (!body) continue;
    sum += located_[i].gradient.dot(fromOde(dBodyGetLinearVel(body)) + fromOde(dBodyGetAngularVel(body)).cross(located_[i].arm));
  }
  return sum;
}

double LineOfPull::totalForceN(double tension_N, double maximum_length_mm, const MuscleSettings& settings,
                               const PhysicsSettings& physics) const {
  const double speed_mm_per_s = speed() / speedRatio(physics);
  const double friction_N = settings.slider_friction_N * (settings.viscous ? speed_mm_per_s / settings.slider_viscous_speed_mm_per_s
                                                                           : std::tanh(speed_mm_per_s / dry_speed_mm_per_s));
  return tension_N + friction_N + stopN(length_mm_, maximum_length_mm);
}

double LineOfPull::stopN(double length_mm, double maximum_length_mm) {
  const double excess_mm = length_mm - maximum_length_mm;
  return excess_mm > 0 ? stop_stiffness_N_per_mm * excess_mm : 0;
}

void LineOfPull::pull(double tension_N, double maximum_length_mm, const MuscleSettings& settings, const PhysicsSettings& physics) const {
  if (!isConnected()) return;
  const double force = totalForceN(tension_N, maximum_length_mm, settings, physics) * physics.force_per_N;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!points_[i].body) continue;
    const Vector f = -force * located_[i].gradient, &x = located_[i].position;
    dBodyAddForceAtPos(points_[i].body, f.x(), f.y(), f.z(), x.x(), x.y(), x.z());
  }
}

std::vector<LineOfPull::Push> LineOfPull::pushes() const {
  std::vector<Push> result;
  locate();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const dBodyID body = points_[i].body;
    if (!body) continue;
    const auto& [arm, position, gradient] = located_[i];
    result.push_back({body, gradient, arm.cross(gradient)});
  }
  return result;
}

double LineOfPull::stiffnessNPerMm(double of_tension_N_per_mm) {
  return of_tension_N_per_mm + stop_stiffness_N_per_mm;
}

double LineOfPull::dampingNsPerMm(const MuscleSettings& settings) {
  return settings.slider_friction_N / (settings.viscous ? settings.slider_viscous_speed_mm_per_s : dry_speed_mm_per_s);
}

}  // namespace musclesim
