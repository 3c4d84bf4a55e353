#include "musclesim/robot/primitive.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "ode_vector.h"

namespace musclesim {

namespace {

constexpr double pi = std::numbers::pi;

void requireFinite(const std::string& what, const Vector& v) {
  if (!v.allFinite()) throw BadParameter(what, fmt::format("({}, {}, {})", v.x(), v.y(), v.z()), "be finite");
}

void requireDirection(const std::string& what, const Vector& v) {
  requireFinite(what, v);
  if (v.norm() == 0) throw BadParameter(what, "(0, 0, 0)", "have a direction");
}

void requireLimits(const std::string& joint, Limits limits) {
  const bool fine = std::isfinite(limits.low_deg) && std::isfinite(limits.high_deg) && limits.low_deg <= limits.high_deg;
  if (!fine)
    throw BadParameter("limits of " + joint, fmt::format("{} .. {} deg", limits.low_deg, limits.high_deg), "be finite and in order");
}

double positive(const std::string& what, double value) {
  if (!(value > 0) || !std::isfinite(value)) throw BadParameter(what, fmt::format("{}", value), "be positive and finite");
  return value;
}

double volumeMm3(const Shape& shape) {
  const Vector& s = shape.size_mm;
  switch (shape.kind) {
    case Shape::Kind::box:
      return s.x() * s.y() * s.z();
    case Shape::Kind::sphere:
      return 4.0 / 3.0 * pi * s.x() * s.x() * s.x();
    case Shape::Kind::capped_cylinder:
      return pi * s.x() * s.x() * s.y() + 4.0 / 3.0 * pi * s.x() * s.x() * s.x();
  }
  return 0;
}

/// Throws unless a joint can be made between a primitive and another (null: the environment).
void requireJoinable(const Primitive& primitive, const Primitive* other) {
  if (!other) return;
  if (&other->body() == &primitive.body())
    throw BadParameter("joint of " + primitive.name() + " and " + other->name() + ": they are the same body");
  if (dBodyGetWorld(other->body().id) != dBodyGetWorld(primitive.body().id))
    throw BadParameter("joint of " + primitive.name() + " and " + other->name() + ": they belong to different simulations");
}

/// Total mass and inertia of a solid of this shape about its centre, in its own axes.
dMass solid(const Shape& shape, double mass_g) {
  dMass mass;
  const Vector& s = shape.size_mm;
  switch (shape.kind) {
    case Shape::Kind::box:
      dMassSetBoxTotal(&mass, mass_g, s.x(), s.y(), s.z());
      break;
    case Shape::Kind::sphere:
      dMassSetSphereTotal(&mass, mass_g, s.x());
      break;
    case Shape::Kind::capped_cylinder:
      dMassSetCapsuleTotal(&mass, mass_g, 3, s.x(), s.y());
      break;
  }
  return mass;
}

dGeomID makeGeom(dSpaceID space, const Shape& shape) {
  const Vector& s = shape.size_mm;
  switch (shape.kind) {
    case Shape::Kind::box:
      return dCreateBox(space, s.x(), s.y(), s.z());
    case Shape::Kind::sphere:
      return dCreateSphere(space, s.x());
    case Shape::Kind::capped_cylinder:
      return dCreateCapsule(space, s.x(), s.y());
  }
  return nullptr;
}

Vector perpendicularTo(const Vector& axis) {
  return axis.unitOrthogonal();
}

Vector normalized(const Vector& axis) {
  return axis.normalized();
}

void setStops(dJointID joint, void (*set)(dJointID, int, dReal), int low, int high, Limits limits) {
  // ODE refuses a low stop above the high stop in force, so the first call is made twice.
  set(joint, low, limits.low_deg * rad_per_deg);
  set(joint, high, limits.high_deg * rad_per_deg);
  set(joint, low, limits.low_deg * rad_per_deg);
}

/// Carries limits of the Euler angles of one body against another: the first axis is fixed to the first body, the third to the second.
dJointID eulerMotor(dBodyID body, dBodyID other, const Vector& axis1, const Vector& axis3) {
  const dJointID motor = dJointCreateAMotor(dBodyGetWorld(body), nullptr);
  dJointAttach(motor, body, other);
  dJointSetAMotorMode(motor, dAMotorEuler);
  dJointSetAMotorAxis(motor, 0, 1, axis1.x(), axis1.y(), axis1.z());
  dJointSetAMotorAxis(motor, 2, other ? 2 : 0, axis3.x(), axis3.y(), axis3.z());
  return motor;
}

}  // namespace

Primitive::Primitive(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, Shape shape)
    : world_(World::of(world)), shape_(std::move(shape)) {
  requireFinite("position of a primitive", position);
  if (!(density >= 0) || !std::isfinite(density))
    throw BadParameter("density of a primitive", fmt::format("{}", density), "be finite and not negative");
  if (mass == 0) mass = positive("density of a primitive without mass", density) * volumeMm3(shape_);
  mass_g_ = positive("mass of a primitive", mass);
  const dBodyID id = dBodyCreate(world);
  const dMass solid_mass = solid(shape_, mass_g_);
  dBodySetMass(id, &solid_mass);
  dBodySetPosition(id, position.x(), position.y(), position.z());
  geom_ = makeGeom(space, shape_);  // a null space: drawn, but never in contact
  dGeomSetBody(geom_, id);
  world_.own(this);
  name_ = fmt::format("primitive_{}", worldIndex());
  body_ = &world_.addBody(id, *this);
}

Primitive::~Primitive() {
  dGeomDestroy(geom_);
  std::erase(body_->parts, this);
  world_.disown(*this);  // it still owns this if a derived class's constructor threw
}

Vector Primitive::getPosition() const {
  return positionOf(body_->id);
}

Eigen::Matrix3d Primitive::getRotation() const {
  return rotationOf(body_->id);
}

void Primitive::setColor(double red, double green, double blue) {
  for (double component : {red, green, blue})
    if (!(component >= 0 && component <= 1)) throw BadParameter("colour of " + name_, fmt::format("{}", component), "lie in 0 .. 1");
  color_.red = red;
  color_.green = green;
  color_.blue = blue;
}

void Primitive::rotate(double angle_deg, const Vector& axis) {
  requireDirection("axis of rotation of " + name_, axis);
  if (!std::isfinite(angle_deg)) throw BadParameter("angle of rotation of " + name_, fmt::format("{}", angle_deg), "be finite");
  if (body_->has_joint) throw BadParameter("rotate " + name_ + ": it already has a joint, whose anchor would be left behind");
  const Eigen::AngleAxisd turn(angle_deg * rad_per_deg, axis.normalized());
  setRotation(body_->id, turn.toRotationMatrix() * getRotation());
}

void Primitive::setInertia(const Vector& moments_g_mm2) {
  if (!(moments_g_mm2.minCoeff() > 0) || !moments_g_mm2.allFinite())
    throw BadParameter("moments of inertia of " + name_ + " must be positive");
  dMass mass;
  dBodyGetMass(body_->id, &mass);
  dMassSetParameters(&mass, mass.mass, 0, 0, 0, moments_g_mm2.x(), moments_g_mm2.y(), moments_g_mm2.z(), 0, 0, 0);
  dBodySetMass(body_->id, &mass);
}

namespace {

/// Sets the joint up again for the present pose, after a body's centre of mass has been moved to another point of the body.
void reattach(Joint& joint, const Vector& anchor) {
  const dJointID id = joint.id();
  dVector3 axis;
  switch (joint.kind()) {
    case Joint::Kind::ball:
      dJointSetBallAnchor(id, anchor.x(), anchor.y(), anchor.z());
      break;
    case Joint::Kind::hinge:
      dJointSetHingeAnchor(id, anchor.x(), anchor.y(), anchor.z());
      break;
    case Joint::Kind::hinge2:
      dJointSetHinge2Anchor(id, anchor.x(), anchor.y(), anchor.z());
      break;
    case Joint::Kind::universal:
      dJointSetUniversalAnchor(id, anchor.x(), anchor.y(), anchor.z());
      break;
    case Joint::Kind::slider:
      dJointGetSliderAxis(id, axis);
      dJointSetSliderAxis(id, axis[0], axis[1], axis[2]);
      break;
    case Joint::Kind::fixed:
      dJointSetFixed(id);
      break;
  }
  joint.takeReference();
}

Vector anchorOf(const Joint& joint) {
  dVector3 anchor = {};
  if (joint.kind() == Joint::Kind::ball) dJointGetBallAnchor(joint.id(), anchor);
  if (joint.kind() == Joint::Kind::hinge) dJointGetHingeAnchor(joint.id(), anchor);
  if (joint.kind() == Joint::Kind::hinge2) dJointGetHinge2Anchor(joint.id(), anchor);
  if (joint.kind() == Joint::Kind::universal) dJointGetUniversalAnchor(joint.id(), anchor);
  return fromOde(anchor);
}

Eigen::Matrix3d pointInertia(double mass_g, const Vector& from_center) {
  return mass_g * (from_center.squaredNorm() * Eigen::Matrix3d::Identity() - from_center * from_center.transpose());
}

}  // namespace

void Primitive::addPointMass(double mass_g, const Vector& point_mm) {
  requireFinite("point mass on " + name_, point_mm);
  dMass mass;
  dBodyGetMass(body_->id, &mass);
  const double total_g = mass.mass + mass_g;
  const Vector center = (mass.mass * getPosition() + mass_g * point_mm) / total_g;
  const Eigen::Matrix3d to_body = getRotation().transpose();
  const Eigen::Matrix3d inertia = matrixFromOde(mass.I) + pointInertia(mass.mass, to_body * (getPosition() - center)) +
                                  pointInertia(mass_g, to_body * (point_mm - center));
  const bool physical =
      total_g > 0 && std::isfinite(total_g) && Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues()[0] > 0;
  if (!physical)
    throw BadParameter("point mass on " + name_, fmt::format("{} g", mass_g), "leave mass and moments of inertia of its body positive");
  std::vector<std::pair<Joint*, Vector>> joints;
  for (const auto& joint : world_.joints())
    if (dJointGetBody(joint->id(), 0) == body_->id || dJointGetBody(joint->id(), 1) == body_->id)
      joints.emplace_back(joint.get(), anchorOf(*joint));
  std::vector<Vector> drawn;
  for (const Primitive* part : body_->parts) drawn.push_back(fromOde(dGeomGetPosition(part->geom_)));
  dMassSetParameters(&mass, total_g, 0, 0, 0, inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2));
  dBodySetMass(body_->id, &mass);
  dBodySetPosition(body_->id, center.x(), center.y(), center.z());
  for (std::size_t i = 0; i < drawn.size(); ++i)
    dGeomSetOffsetWorldPosition(body_->parts[i]->geom_, drawn[i].x(), drawn[i].y(), drawn[i].z());
  for (const auto& [joint, anchor] : joints) reattach(*joint, anchor);
}

void Primitive::place(const Vector& position_mm, const Eigen::Matrix3d& rotation) {
  requireFinite("position of " + name_, position_mm);
  dBodySetPosition(body_->id, position_mm.x(), position_mm.y(), position_mm.z());
  setRotation(body_->id, rotation);
  dBodySetLinearVel(body_->id, 0, 0, 0);
  dBodySetAngularVel(body_->id, 0, 0, 0);
}

Joint* Primitive::addJoint(Joint::Kind kind, dJointID joint, Primitive* other, const std::string& what) {
  body_->has_joint = true;
  if (other) other->body_->has_joint = true;
  return &world_.addJoint(kind, joint, fmt::format("{} of {} and {}", what, name_, other ? other->name_ : "environment"));
}

void Primitive::fix() {
  const dJointID joint = dJointCreateFixed(world_, nullptr);
  dJointAttach(joint, body_->id, nullptr);
  dJointSetFixed(joint);
  addJoint(Joint::Kind::fixed, joint, nullptr, "fixation");
}

Joint* Primitive::attachBall(Primitive* other, const Vector& anchor) {
  requireJoinable(*this, other);
  requireFinite("anchor of a ball joint of " + name_, anchor);
  const dJointID joint = dJointCreateBall(world_, nullptr);
  dJointAttach(joint, body_->id, other ? other->body_->id : nullptr);
  dJointSetBallAnchor(joint, anchor.x(), anchor.y(), anchor.z());
  return addJoint(Joint::Kind::ball, joint, other, "ball joint");
}

Joint* Primitive::attachBall(Primitive* other, const Vector& anchor, const Vector& axis1, const Vector& axis3, Limits limits1,
                             Limits limits2, Limits limits3) {
  requireDirection("first axis of a ball joint of " + name_, axis1);
  requireDirection("third axis of a ball joint of " + name_, axis3);
  for (const Limits& limits : {limits1, limits2, limits3}) requireLimits("a ball joint of " + name_, limits);
  if (std::abs(normalized(axis1).dot(normalized(axis3))) > 1e-9)
    throw BadParameter("axes of a ball joint of " + name_, "not perpendicular", "be perpendicular in the pose as built");
  Joint* ball = attachBall(other, anchor);
  const dJointID motor = eulerMotor(body_->id, other ? other->body_->id : nullptr, axis1, axis3);
  setStops(motor, dJointSetAMotorParam, dParamLoStop1, dParamHiStop1, limits1);
  setStops(motor, dJointSetAMotorParam, dParamLoStop2, dParamHiStop2, limits2);
  setStops(motor, dJointSetAMotorParam, dParamLoStop3, dParamHiStop3, limits3);
  return ball;
}

Joint* Primitive::attachHinge(Primitive* other, const Vector& anchor, const Vector& axis) {
  requireJoinable(*this, other);
  requireFinite("anchor of a hinge of " + name_, anchor);
  requireDirection("axis of a hinge of " + name_, axis);
  const dJointID joint = dJointCreateHinge(world_, nullptr);
  dJointAttach(joint, body_->id, other ? other->body_->id : nullptr);
  dJointSetHingeAnchor(joint, anchor.x(), anchor.y(), anchor.z());
  const Vector unit_axis = normalized(axis);
  dJointSetHingeAxis(joint, unit_axis.x(), unit_axis.y(), unit_axis.z());
  return addJoint(Joint::Kind::hinge, joint, other, "hinge");
}

Joint* Primitive::attachHinge(Primitive* other, const Vector& anchor, const Vector& axis, double low_deg, double high_deg) {
  requireLimits("a hinge of " + name_, {low_deg, high_deg});
  Joint* joint = attachHinge(other, anchor, axis);
  setStops(joint->id(), dJointSetHingeParam, dParamLoStop, dParamHiStop, {low_deg, high_deg});
  return joint;
}

Joint* Primitive::attachHinge(Primitive* other, const Vector& anchor, const Vector& axis1, const Vector& axis2) {
  requireJoinable(*this, other);
  requireFinite("anchor of a hinge of " + name_, anchor);
  requireDirection("first axis of a hinge of " + name_, axis1);
  requireDirection("second axis of a hinge of " + name_, axis2);
  if (!other) throw BadParameter("hinge with two axes of " + name_ + ": must connect two primitives, not one and the environment");
  if (normalized(axis1).cross(normalized(axis2)).norm() < 1e-9)
    throw BadParameter("axes of a hinge of " + name_, "parallel", "have different directions");
  const dJointID joint = dJointCreateHinge2(world_, nullptr);
  dJointAttach(joint, body_->id, other->body_->id);
  dJointSetHinge2Anchor(joint, anchor.x(), anchor.y(), anchor.z());
  const dReal first[4] = {axis1.x(), axis1.y(), axis1.z(), 0}, second[4] = {axis2.x(), axis2.y(), axis2.z(), 0};
  dJointSetHinge2Axes(joint, first, second);
  return addJoint(Joint::Kind::hinge2, joint, other, "two-axis hinge");
}

Joint* Primitive::attachHinge(Primitive* other, const Vector& anchor, const Vector& axis1, const Vector& axis2, Limits limits1,
                              Limits limits2) {
  requireLimits("a hinge of " + name_, limits1);
  requireLimits("a hinge of " + name_, limits2);
  requireDirection("first axis of a hinge of " + name_, axis1);
  requireDirection("second axis of a hinge of " + name_, axis2);
  if (std::abs(normalized(axis1).dot(normalized(axis2))) > 1e-9)
    throw BadParameter("axes of a hinge with limits of " + name_, "not perpendicular", "be perpendicular");
  Joint* joint = attachHinge(other, anchor, axis1, axis2);
  setStops(joint->id(), dJointSetHinge2Param, dParamLoStop1, dParamHiStop1, limits1);
  // ODE's hinge-2 knows no stops about its second axis; it is the third Euler angle, the second being held at 0 by the joint.
  const dJointID motor = eulerMotor(body_->id, other->body_->id, axis1, axis2);
  setStops(motor, dJointSetAMotorParam, dParamLoStop3, dParamHiStop3, limits2);
  return joint;
}

Joint* Primitive::attachUniversal(Primitive* other, const Vector& anchor, const Vector& axis1, const Vector& axis2) {
  requireJoinable(*this, other);
  requireFinite("anchor of a universal joint of " + name_, anchor);
  requireDirection("first axis of a universal joint of " + name_, axis1);
  requireDirection("second axis of a universal joint of " + name_, axis2);
  if (std::abs(normalized(axis1).dot(normalized(axis2))) > 1e-9)
    throw BadParameter("axes of a universal joint of " + name_, "not perpendicular", "be perpendicular");
  const dJointID joint = dJointCreateUniversal(world_, nullptr);
  dJointAttach(joint, body_->id, other ? other->body_->id : nullptr);
  dJointSetUniversalAnchor(joint, anchor.x(), anchor.y(), anchor.z());
  dJointSetUniversalAxis1(joint, axis1.x(), axis1.y(), axis1.z());
  dJointSetUniversalAxis2(joint, axis2.x(), axis2.y(), axis2.z());
  return addJoint(Joint::Kind::universal, joint, other, "universal joint");
}

Joint* Primitive::attachUniversal(Primitive* other, const Vector& anchor, const Vector& axis1, const Vector& axis2, Limits limits1,
                                  Limits limits2) {
  requireLimits("a universal joint of " + name_, limits1);
  requireLimits("a universal joint of " + name_, limits2);
  Joint* joint = attachUniversal(other, anchor, axis1, axis2);
  setStops(joint->id(), dJointSetUniversalParam, dParamLoStop1, dParamHiStop1, limits1);
  setStops(joint->id(), dJointSetUniversalParam, dParamLoStop2, dParamHiStop2, limits2);
  return joint;
}

Joint* Primitive::attachUniversal(Primitive* other, const Vector& anchor, const Vector& axis) {
  requireDirection("axis of a universal joint of " + name_, axis);
  Joint* joint = attachUniversal(other, anchor, axis, perpendicularTo(axis));
  setStops(joint->id(), dJointSetUniversalParam, dParamLoStop2, dParamHiStop2, {0, 0});
  return joint;
}

Joint* Primitive::attachUniversal(Primitive* other, const Vector& anchor, const Vector& axis, double low_deg, double high_deg) {
  requireLimits("a universal joint of " + name_, {low_deg, high_deg});
  Joint* joint = attachUniversal(other, anchor, axis);
  setStops(joint->id(), dJointSetUniversalParam, dParamLoStop1, dParamHiStop1, {low_deg, high_deg});
  return joint;
}

Joint* Primitive::attachSlider(Primitive* other, const Vector& axis) {
  requireJoinable(*this, other);
  requireDirection("axis of a slider of " + name_, axis);
  const dJointID joint = dJointCreateSlider(world_, nullptr);
  dJointAttach(joint, body_->id, other ? other->body_->id : nullptr);
  dJointSetSliderAxis(joint, axis.x(), axis.y(), axis.z());
  return addJoint(Joint::Kind::slider, joint, other, "slider");
}

Joint& Primitive::hinge(Primitive* other, const HingeOptions& options) {
  const Vector anchor_mm = options.anchor_mm.value_or(getPosition());
  if (!options.limits_deg) return *attachHinge(other, anchor_mm, options.axis);
  return *attachHinge(other, anchor_mm, options.axis, options.limits_deg->low_deg, options.limits_deg->high_deg);
}

void Primitive::requireComposable() const {
  if (body_->has_joint) throw BadParameter("composing " + name_ + ": it already has a joint; compose first, then attach and fix");
}

void Primitive::compositeWithPrimitive(Primitive* other) {
  compositePrimitives({this, other}, this);
}

void Primitive::compositePrimitives(const std::vector<Primitive*>& parts, Primitive* parent) {
  if (parts.size() < 2) throw BadParameter("composing primitives: at least two are needed");
  if (std::find(parts.begin(), parts.end(), nullptr) != parts.end()) throw BadParameter("composing primitives: one of them is null");
  if (!parent) parent = parts.back();
  std::vector<Body*> bodies;
  for (Primitive* part : parts) {
    if (&part->world_ != &parent->world_) throw BadParameter("composing primitives: they belong to different simulations");
    part->requireComposable();
    if (std::find(bodies.begin(), bodies.end(), part->body_) != bodies.end())
      throw BadParameter("composing primitives: " + part->name_ + " is already part of the same body");
    bodies.push_back(part->body_);
  }
  if (std::find(bodies.begin(), bodies.end(), parent->body_) == bodies.end())
    throw BadParameter("composing primitives: the parent " + parent->name_ + " is not among the parts");
  merge(*parent->body_, bodies, *parent);
}

/// One body at the common centre of mass, oriented like the parent. With "exact" inertia
///     I = sum_i R_i I_i R_i^T + m_i (|d_i|^2 E - d_i d_i^T)
/// in the parent's axes, R_i the orientation and d_i the displacement of part i; with "summed" the original's sum of the I_i as they are.
void Primitive::merge(Body& target, const std::vector<Body*>& bodies, Primitive& parent) {
  const bool exact = parent.world_.physics().composite_inertia == CompositeInertia::exact;
  double total_mass_g = 0;
  Vector center = Vector::Zero();
  std::vector<dMass> masses(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    dBodyGetMass(bodies[i]->id, &masses[i]);
    total_mass_g += masses[i].mass;
    center += masses[i].mass * positionOf(bodies[i]->id);
  }
  center /= total_mass_g;
  const Eigen::Matrix3d orientation = rotationOf(target.id);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Eigen::Matrix3d own = matrixFromOde(masses[i].I);
    if (!exact) {
      inertia += own;
      continue;
    }
    const Eigen::Matrix3d turn = orientation.transpose() * rotationOf(bodies[i]->id);
    const Vector d = orientation.transpose() * (positionOf(bodies[i]->id) - center);
    inertia += turn * own * turn.transpose() + masses[i].mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  }

  struct Placed {
    Primitive* part;
    Vector position;
    Eigen::Matrix3d rotation;
  };
  std::vector<Placed> placed;
  for (Body* body : bodies)
    for (Primitive* part : body->parts)
      placed.push_back({part, fromOde(dGeomGetPosition(part->geom_)), matrixFromOde(dGeomGetRotation(part->geom_))});
  for (Body* body : bodies) {
    if (body == &target) continue;
    for (Primitive* part : body->parts) {
      dGeomClearOffset(part->geom_);  // dGeomSetBody would lose the memory of an offset
      dGeomSetBody(part->geom_, target.id);
    }
    parent.world_.removeBody(*body);
  }
  dMass mass;
  dMassSetParameters(&mass, total_mass_g, 0, 0, 0, inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(0, 2),
                     inertia(1, 2));
  dBodySetMass(target.id, &mass);
  dBodySetPosition(target.id, center.x(), center.y(), center.z());
  target.parts.clear();
  for (const Placed& p : placed) {
    p.part->body_ = &target;
    target.parts.push_back(p.part);
    dGeomSetOffsetWorldPosition(p.part->geom_, p.position.x(), p.position.y(), p.position.z());
    const auto& r = p.rotation;
    const dMatrix3 rotation = {r(0, 0), r(0, 1), r(0, 2), 0, r(1, 0), r(1, 1), r(1, 2), 0, r(2, 0), r(2, 1), r(2, 2), 0};
    dGeomSetOffsetWorldRotation(p.part->geom_, rotation);
  }
}

Box::Box(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double x, double y, double z)
    : Primitive(world, space, position, mass, density,
                {Shape::Kind::box, {positive("edge of a box", x), positive("edge of a box", y), positive("edge of a box", z)}}) {}

Sphere::Sphere(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double radius)
    : Primitive(world, space, position, mass, density, {Shape::Kind::sphere, {positive("radius of a sphere", radius), 0, 0}}) {}

CappedCylinder::CappedCylinder(dWorldID world, dSpaceID space, const Vector& position, double mass, double density, double radius,
                               double length)
    : Primitive(world, space, position, mass, density,
                {Shape::Kind::capped_cylinder,
                 {positive("radius of a capped cylinder", radius), positive("length of a capped cylinder", length), 0}}) {}

}  // namespace musclesim
