#include "springs.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "ode_vector.h"
#include "vector_checks.h"

namespace musclesim {

namespace {

/// True speed over speed in world units: in `original`, forces are too small by a factor, and speeds by its square root.
double trueSpeedRatio(const PhysicsSettings& physics) {
  return std::sqrt(world_force_per_N / physics.force_per_N);
}

void requireNotNegative(const std::string& what, double value) {
  if (!(value >= 0) || !std::isfinite(value)) throw BadParameter(what, fmt::format("{}", value), "be finite and not negative");
}

struct Motion {
  Vector position, velocity, arm;  ///< of a point: world frame, mm, mm/s in world units; the arm from the body's centre of mass
};

Motion motionOf(const Attachment& point) {
  if (!point.primitive) return {point.point_mm, Vector::Zero(), Vector::Zero()};
  const dBodyID body = point.primitive->body().id;
  const Vector arm = rotationOf(body) * point.point_mm;
  return {positionOf(body) + arm, fromOde(dBodyGetLinearVel(body)) + fromOde(dBodyGetAngularVel(body)).cross(arm), arm};
}

Attachment inBody(const Attachment& point) {
  if (!point.primitive) return point;
  const dBodyID body = point.primitive->body().id;
  point.primitive->body().has_joint = true;  // from now on its body must not be merged into another body
  return {point.primitive, rotationOf(body).transpose() * (point.point_mm - positionOf(body))};
}

void shift(Attachment& point, dBodyID body, const Vector& shift_mm) {
  if (point.primitive && point.primitive->body().id == body) point.point_mm -= shift_mm;
}

void push(const Attachment& point, const Motion& motion, const Vector& force_N, const ForceElement::AddLoad& add) {
  if (point.primitive) add(point.primitive->body().id, {force_N, motion.arm.cross(force_N)});
}

/// Spring and damper on the first axis of a joint. Dry friction takes the joint's motor; the damping is a force then.
class JointSpring final : public ForceElement {
 public:
  JointSpring(World& world, const Joint& joint, double damping, double stiffness, double rest)
      : joint_(joint), speed_ratio_(trueSpeedRatio(world.physics())), damping_(damping), stiffness_(stiffness), rest_(rest) {}

  void load(bool at_rest, const AddLoad& add) const override {
    joint_.freeAtStops();
    const double damping = at_rest || joint_.dryFriction() == 0 ? 0 : damping_;
    if (stiffness_ == 0 && damping == 0) return;
    joint_.kind() == Joint::Kind::slider ? loadSlider(damping, add) : loadHinge(damping, add);
  }
  bool onlyDampsAJoint() const override { return stiffness_ == 0; }

 private:
  void loadHinge(double damping, const AddLoad& add) const {
    dVector3 axis;
    const bool hinge = joint_.kind() == Joint::Kind::hinge;
    hinge ? dJointGetHingeAxis(joint_.id(), axis) : dJointGetUniversalAxis1(joint_.id(), axis);
    const double rate = hinge ? dJointGetHingeAngleRate(joint_.id()) : dJointGetUniversalAngle1Rate(joint_.id());
    const double torque_Nm = -stiffness_ * (joint_.angleDeg() - rest_) * rad_per_deg - damping * rate * speed_ratio_;
    const Vector torque_Nmm = torque_Nm * mm_per_m * fromOde(axis);
    for (const int side : {0, 1})
      if (const dBodyID body = dJointGetBody(joint_.id(), side)) add(body, {Vector::Zero(), side == 0 ? torque_Nmm : Vector(-torque_Nmm)});
  }
  void loadSlider(double damping, const AddLoad& add) const {
    dVector3 axis;
    dJointGetSliderAxis(joint_.id(), axis);
    const double rate = dJointGetSliderPositionRate(joint_.id());
    const double force_N = -stiffness_ * (dJointGetSliderPosition(joint_.id()) - rest_) - damping * rate * speed_ratio_ / mm_per_m;
    const Vector force = force_N * fromOde(axis);
    for (const int side : {0, 1})
      if (const dBodyID body = dJointGetBody(joint_.id(), side)) add(body, {side == 0 ? force : Vector(-force), Vector::Zero()});
  }

  const Joint& joint_;
  double speed_ratio_, damping_, stiffness_, rest_;
};

}  // namespace

void addJointMechanics(World& world, Joint& joint, const JointMechanics& m) {
  const std::string of = " of joint " + joint.name();
  requireNotNegative("friction" + of, m.friction);
  requireNotNegative("damping" + of, m.damping);
  requireNotNegative("stiffness" + of, m.stiffness);
  if (!std::isfinite(m.rest)) throw BadParameter("rest" + of, fmt::format("{}", m.rest), "be finite");
  const PhysicsSettings& physics = world.physics();
  const bool slides = joint.kind() == Joint::Kind::slider;
  joint.addDryFriction(m.friction * physics.force_per_N * (slides ? 1 : mm_per_m));
  if (m.damping > 0)
    joint.dampByMotor(1 / (m.damping * physics.force_per_N * trueSpeedRatio(physics) * (slides ? 1 / mm_per_m : mm_per_m)));
  if (m.stiffness > 0 || m.damping > 0) world.addForceElement(std::make_unique<JointSpring>(world, joint, m.damping, m.stiffness, m.rest));
}

PointSpring::PointSpring(World& world, const Attachment& from, const Attachment& to, const PointSpringSettings& settings)
    : speed_ratio_(trueSpeedRatio(world.physics())), ends_{inBody(from), inBody(to)}, settings_(settings) {
  requireFinite("an end of a spring", from.point_mm);
  requireFinite("an end of a spring", to.point_mm);
  requireNotNegative("stiffness of a spring", settings.stiffness_N_per_mm);
  requireNotNegative("rest length of a spring", settings.rest_mm);
  requireNotNegative("damping of a spring", settings.damping_Ns_per_m);
}

std::pair<Vector, Vector> PointSpring::endsMm() const {
  return {motionOf(ends_[0]).position, motionOf(ends_[1]).position};
}

double PointSpring::lengthMm() const {
  const auto [from, to] = endsMm();
  return (to - from).norm();
}

void PointSpring::load(bool at_rest, const AddLoad& add) const {
  const Motion from = motionOf(ends_[0]), to = motionOf(ends_[1]);
  const Vector along = to.position - from.position;
  const double length_mm = along.norm();
  if (!(length_mm > 0) || (settings_.pulls_only && length_mm < settings_.rest_mm)) return;
  const Vector direction = along / length_mm;
  double force_N = settings_.stiffness_N_per_mm * (length_mm - settings_.rest_mm);
  if (!at_rest) force_N += settings_.damping_Ns_per_m * direction.dot(to.velocity - from.velocity) * speed_ratio_ / mm_per_m;
  if (settings_.pulls_only) force_N = std::max(0.0, force_N);
  push(ends_[0], from, force_N * direction, add);
  push(ends_[1], to, -force_N * direction, add);
}

void PointSpring::moveCenter(dBodyID body, const Vector& shift_mm) {
  for (Attachment& end : ends_) shift(end, body, shift_mm);
}

Wall::Wall(World&, const Attachment& point, const Vector& at_mm, const Vector& normal, double stiffness_N_per_mm)
    : point_(inBody(point)), at_mm_(at_mm), normal_(normal.normalized()), stiffness_N_per_mm_(stiffness_N_per_mm) {
  requireFinite("a point of a wall", at_mm);
  requireDirection("normal of a wall", normal);
  if (!(stiffness_N_per_mm > 0) || !std::isfinite(stiffness_N_per_mm))
    throw BadParameter("stiffness of a wall", fmt::format("{}", stiffness_N_per_mm), "be positive and finite");
}

void Wall::moveCenter(dBodyID body, const Vector& shift_mm) {
  shift(point_, body, shift_mm);
}

void Wall::load(bool, const AddLoad& add) const {
  const Motion point = motionOf(point_);
  const double depth_mm = normal_.dot(at_mm_ - point.position);
  if (depth_mm > 0) push(point_, point, stiffness_N_per_mm_ * depth_mm * normal_, add);
}

}  // namespace musclesim
