#include "musclesim/robot/joint.h"

#include <fmt/format.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "ode_vector.h"

namespace musclesim {

namespace {

/// A point of the world frame in a body's frame; null: the environment.
Vector pointSeenFrom(dBodyID body, const Vector& point) {
  return body ? Vector(rotationOf(body).transpose() * (point - positionOf(body))) : point;
}

Vector directionSeenFrom(dBodyID body, const Vector& direction) {
  return body ? Vector(rotationOf(body).transpose() * direction) : direction;
}

/// Anchor and axes in the world; what the joint does not have stays as it is.
void readFrame(Joint::Kind kind, dJointID id, dVector3& anchor, dVector3 (&axis)[2]) {
  switch (kind) {
    case Joint::Kind::ball:
      return dJointGetBallAnchor(id, anchor);
    case Joint::Kind::hinge:
      dJointGetHingeAnchor(id, anchor);
      dJointGetHingeAxis(id, axis[0]);
      return dJointGetHingeAxis(id, axis[1]);
    case Joint::Kind::hinge2:
      dJointGetHinge2Anchor(id, anchor);
      dJointGetHinge2Axis1(id, axis[0]);
      return dJointGetHinge2Axis2(id, axis[1]);
    case Joint::Kind::universal:
      dJointGetUniversalAnchor(id, anchor);
      dJointGetUniversalAxis1(id, axis[0]);
      return dJointGetUniversalAxis2(id, axis[1]);
    case Joint::Kind::slider:
      dJointGetSliderAxis(id, axis[0]);
      return dJointGetSliderAxis(id, axis[1]);
    case Joint::Kind::fixed:
      return;
  }
}

JointReference referenceOf(Joint::Kind kind, dJointID id) {
  dBodyID body[2] = {dJointGetBody(id, 0), dJointGetBody(id, 1)};
  JointReference reference = {{Vector::Zero(), Vector::Zero()}, {Vector::Zero(), Vector::Zero()}, Vector::Zero(), {1, 0, 0, 0}};
  if (!body[0]) return reference;
  dVector3 anchor = {}, axis[2] = {};
  readFrame(kind, id, anchor, axis);
  for (int i = 0; i < 2; ++i) {
    reference.anchor[i] = pointSeenFrom(body[i], fromOde(anchor));
    reference.axis[i] = directionSeenFrom(body[i], fromOde(axis[i]));
  }
  reference.offset = pointSeenFrom(body[1], positionOf(body[0]));
  const dReal unturned[4] = {1, 0, 0, 0};
  dQuaternion rotation;
  dQMultiply1(rotation, dBodyGetQuaternion(body[0]), body[1] ? dBodyGetQuaternion(body[1]) : unturned);
  reference.rotation = {rotation[0], rotation[1], rotation[2], rotation[3]};
  return reference;
}

}  // namespace

Joint::Joint(Kind kind, dJointID id, std::string name)
    : kind_(kind), id_(id), name_(std::move(name)), reference_pose_(referenceOf(kind, id)), reference_(Vector::Zero()) {
  if (kind_ == Kind::slider || kind_ == Kind::fixed) reference_ = separation();
}

void Joint::takeReference() {
  reference_pose_ = referenceOf(kind_, id_);
  if (kind_ == Kind::slider || kind_ == Kind::fixed) reference_ = separation();
}

void Joint::setParameter(int which, double value) const {
  switch (kind_) {
    case Kind::slider:
      return dJointSetSliderParam(id_, which, value);
    case Kind::hinge:
      return dJointSetHingeParam(id_, which, value);
    case Kind::universal:
      return dJointSetUniversalParam(id_, which, value);
    default:
      throw BadParameter(fmt::format("joint {} is neither a slider nor has it an axis of a hinge", name_));
  }
}

double Joint::parameter(int which) const {
  return kind_ == Kind::slider  ? dJointGetSliderParam(id_, which)
         : kind_ == Kind::hinge ? dJointGetHingeParam(id_, which)
                                : dJointGetUniversalParam(id_, which);
}

void Joint::addDryFriction(double force) {
  if (force == 0) return;
  setParameter(dParamVel, 0);
  // A robot in C++ may have set a largest force itself.
  if (const double set = parameter(dParamFMax); dry_friction_ == 0 && damping_softness_ == 0 && std::isfinite(set)) dry_friction_ = set;
  dry_friction_ += force;
  setParameter(dParamFMax, dry_friction_);
  // CFM (softness) is a speed per force: under its full friction the joint creeps by a millionth of a rad or mm per second.
  constexpr double creep_per_s = 1e-6;
  setParameter(dParamCFM, creep_per_s / dry_friction_);
}

void Joint::dampByMotor(double softness) {
  damping_softness_ = softness;
  if (dry_friction_ > 0) return;
  setParameter(dParamVel, 0);
  setParameter(dParamFMax, dInfinity);
  setParameter(dParamCFM, softness);
}

void Joint::freeAtStops() const {
  if (damping_softness_ == 0 || dry_friction_ > 0) return;
  const double position = kind_ == Kind::slider  ? dJointGetSliderPosition(id_)
                          : kind_ == Kind::hinge ? dJointGetHingeAngle(id_)
                                                 : dJointGetUniversalAngle1(id_);
  const bool at_stop = position <= parameter(dParamLoStop) || position >= parameter(dParamHiStop);
  setParameter(dParamFMax, at_stop ? 0 : dInfinity);
}

int Joint::angleCount() const {
  if (kind_ == Kind::hinge) return 1;
  return kind_ == Kind::hinge2 || kind_ == Kind::universal ? 2 : 0;
}

/// The number of turns that brings an angle between -180 and 180 degrees nearest to the one counted last.
double Joint::turnsAt(double wrapped_deg, int axis) const {
  return std::round((counted_deg_[axis] - wrapped_deg) / 360);
}

double Joint::angleDeg(int axis) const {
  const double wrapped_deg = wrappedAngleDeg(axis), turns = turnsAt(wrapped_deg, axis);
  return turns == 0 ? wrapped_deg : wrapped_deg + 360 * turns;  // -0 stays -0
}

void Joint::countTurns(bool from_zero) {
  for (int axis = 0; axis < angleCount(); ++axis) {
    const double wrapped_deg = wrappedAngleDeg(axis);
    counted_deg_[axis] = wrapped_deg + (from_zero ? 0 : 360 * turnsAt(wrapped_deg, axis));
  }
}

double Joint::wrappedAngleDeg(int axis) const {
  if (kind_ == Kind::hinge && axis == 0) return dJointGetHingeAngle(id_) * deg_per_rad;
  if (kind_ == Kind::hinge2 && axis == 0) return dJointGetHinge2Angle1(id_) * deg_per_rad;
  if (kind_ == Kind::hinge2 && axis == 1)
    return -dJointGetHinge2Angle2(id_) * deg_per_rad;  // ODE's sign: second body relative to the first
  if (kind_ == Kind::universal && axis == 0) return dJointGetUniversalAngle1(id_) * deg_per_rad;
  if (kind_ == Kind::universal && axis == 1) return dJointGetUniversalAngle2(id_) * deg_per_rad;
  throw BadParameter("joint " + name_ + " has no angle about axis " + std::to_string(axis));
}

std::pair<double, double> Joint::stopsDeg(int axis) const {
  auto inDegrees = [this](dReal (*get)(dJointID, int), int low, int high) {
    return std::pair<double, double>{get(id_, low) * deg_per_rad, get(id_, high) * deg_per_rad};
  };
  if (kind_ == Kind::hinge && axis == 0) return inDegrees(dJointGetHingeParam, dParamLoStop, dParamHiStop);
  if (kind_ == Kind::hinge2 && axis == 0) return inDegrees(dJointGetHinge2Param, dParamLoStop1, dParamHiStop1);
  if (kind_ == Kind::universal && axis == 0) return inDegrees(dJointGetUniversalParam, dParamLoStop1, dParamHiStop1);
  if (kind_ == Kind::universal && axis == 1) return inDegrees(dJointGetUniversalParam, dParamLoStop2, dParamHiStop2);
  angleDeg(axis);  // throws if there is no such axis
  return {-dInfinity, dInfinity};
}

void Joint::setSliderStopsMm(double low_mm, double high_mm) {
  if (kind_ != Kind::slider) throw BadParameter("stops in mm of joint " + name_ + ": it is not a slider");
  if (!(std::isfinite(low_mm) && std::isfinite(high_mm) && low_mm <= 0 && high_mm >= 0))
    throw BadParameter("limits of joint " + name_, fmt::format("{} .. {} mm", low_mm, high_mm),
                       "be finite, in order and contain 0 mm, the pose as built");
  dJointSetSliderParam(id_, dParamLoStop, low_mm);
  dJointSetSliderParam(id_, dParamHiStop, high_mm);
}

Vector Joint::separation() const {
  const dBodyID first = dJointGetBody(id_, 0), second = dJointGetBody(id_, 1);
  if (!first) return rotationOf(second).transpose() * -positionOf(second);
  const Vector other = second ? positionOf(second) : Vector::Zero();
  return rotationOf(first).transpose() * (other - positionOf(first));
}

double Joint::constraintErrorMm() const {
  dVector3 on_first, on_second;
  switch (kind_) {
    case Kind::ball:
      dJointGetBallAnchor(id_, on_first);
      dJointGetBallAnchor2(id_, on_second);
      break;
    case Kind::hinge:
      dJointGetHingeAnchor(id_, on_first);
      dJointGetHingeAnchor2(id_, on_second);
      break;
    case Kind::hinge2:
      dJointGetHinge2Anchor(id_, on_first);
      dJointGetHinge2Anchor2(id_, on_second);
      break;
    case Kind::universal:
      dJointGetUniversalAnchor(id_, on_first);
      dJointGetUniversalAnchor2(id_, on_second);
      break;
    case Kind::slider: {
      dVector3 axis_world;
      dJointGetSliderAxis(id_, axis_world);
      const dBodyID first = dJointGetBody(id_, 0);
      const Vector axis = rotationOf(first ? first : dJointGetBody(id_, 1)).transpose() * fromOde(axis_world);
      const Vector moved = separation() - reference_;
      return (moved - axis * axis.dot(moved)).norm();
    }
    case Kind::fixed:
      return (separation() - reference_).norm();
  }
  return (fromOde(on_first) - fromOde(on_second)).norm();
}

}  // namespace musclesim
