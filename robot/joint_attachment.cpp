/// The joints of a primitive: Primitive::attachBall and its like.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "joint_limits.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/primitive.h"
#include "vector_checks.h"

namespace musclesim {

namespace {

/// Throws unless a joint can be made between a primitive and another (null: the environment).
void requireJoinable(const Primitive& primitive, const Primitive* other) {
  if (!other) return;
  if (&other->body() == &primitive.body())
    throw BadParameter("joint of " + primitive.name() + " and " + other->name() + ": they are the same body");
  if (dBodyGetWorld(other->body().id) != dBodyGetWorld(primitive.body().id))
    throw BadParameter("joint of " + primitive.name() + " and " + other->name() + ": they belong to different simulations");
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
  for (const Limits& limits : {limits1, limits3}) requireLimits("a ball joint of " + name_, limits);
  requireLimits("a ball joint of " + name_, limits2, farthest_middle_stop_deg);
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

}  // namespace musclesim
