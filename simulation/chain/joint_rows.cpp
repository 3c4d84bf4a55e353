#include "joint_rows.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace musclesim::chain {

namespace {

constexpr double pi = std::numbers::pi;

struct Pair {
  const BodyMotion& first;
  const BodyMotion& second;
  bool has_second;
};

Pair bodiesOf(const JointModel& joint, const BodyState& bodies) {
  return {bodies[joint.body[0]], bodies[joint.body[1]], joint.body[1] >= 0};
}

/// Two unit vectors that span the plane perpendicular to the unit vector n, chosen as dPlaneSpace chooses them.
void planeAcross(const Vector& n, Vector& p, Vector& q) {
  constexpr double half_root = std::numbers::sqrt2 / 2;
  if (std::abs(n.z()) > half_root) {
    const double a = n.y() * n.y() + n.z() * n.z();
    const double k = 1 / std::sqrt(a);
    p = {0, -n.z() * k, n.y() * k};
    q = {a * k, -n.x() * p.z(), n.x() * p.y()};
  } else {
    const double a = n.x() * n.x() + n.y() * n.y();
    const double k = 1 / std::sqrt(a);
    p = {-n.y() * k, n.x() * k, 0};
    q = {-n.z() * p.y(), n.z() * p.x(), a * k};
  }
}

void setRow(JointRows& rows, int body, int row, const Vector& linear, const Vector& angular) {
  double* j = rows.jacobian[body][row];
  for (int i = 0; i < 3; ++i) {
    j[i] = linear[i];
    j[3 + i] = angular[i];
  }
}

/// Rotation of the second body relative to the first since registration, as a quaternion in the first body's frame.
Quaternion turnOf(const JointModel& joint, const Pair& pair) {
  const Quaternion relative = product(conjugate(pair.first.quaternion), pair.second.quaternion);
  return product(relative, conjugate(joint.reference.rotation));
}

/// Three rows w1 - w2 = 2 k e, where e is the vector part of that rotation in the world frame.
void setOrientationRows(const JointModel& joint, const Pair& pair, double k, int first_row, JointRows& rows) {
  const Quaternion turn = turnOf(joint, pair);
  const Vector e = pair.first.rotation * ((turn[0] < 0 ? -1.0 : 1.0) * turn.tail<3>());
  for (int i = 0; i < 3; ++i) {
    rows.jacobian[0][first_row + i][3 + i] = 1;
    if (pair.has_second) rows.jacobian[1][first_row + i][3 + i] = -1;
    rows.velocity[first_row + i] = 2 * k * e[i];
  }
}

/// Three rows v1 + w1 x a1 - v2 - w2 x a2 = k (x2 + a2 - x1 - a1), where a is the anchor seen from each centre of mass.
void setAnchorRows(const JointModel& joint, const Pair& pair, double k, JointRows& rows) {
  const Vector a1 = pair.first.rotation * joint.reference.anchor[0];
  const Vector a2 = pair.second.rotation * joint.reference.anchor[1];
  const Vector error = a2 + pair.second.position - a1 - pair.first.position;
  for (int i = 0; i < 3; ++i) {
    const Vector e = Vector::Unit(i);
    setRow(rows, 0, i, e, a1.cross(e));
    if (pair.has_second) setRow(rows, 1, i, -e, -a2.cross(e));
    rows.velocity[i] = k * error[i];
  }
}

/// The stop that the joint has reached. Like ODE, it is tested with the position before the step.
AxisContact stopAt(const AxisLimits& limits, double position, bool active) {
  if (active && limits.low_stop <= limits.high_stop) {
    if (limits.low_stop == limits.high_stop) return AxisContact::locked;
    if (position <= limits.low_stop) return AxisContact::low_stop;
    if (position >= limits.high_stop) return AxisContact::high_stop;
  }
  return limits.motor_force > 0 ? AxisContact::motor : AxisContact::none;
}

/// Velocity of the joint along its axis row before the step.
double axisVelocity(const Pair& pair, const JointRows& rows, bool rotational) {
  double velocity = 0;
  for (int i = 0; i < 3; ++i) {
    const int component = rotational ? 3 + i : i;
    velocity += rows.jacobian[0][5][component] * (rotational ? pair.first.spin[i] : pair.first.velocity[i]);
    velocity += rows.jacobian[1][5][component] * (rotational ? pair.second.spin[i] : pair.second.velocity[i]);
  }
  return velocity;
}

/// Row 5 without a stop: motor (dry friction) with bounds -+ F.
void setMotorRow(const AxisLimits& limits, JointRows& rows) {
  rows.velocity[5] = limits.motor_velocity;
  rows.softness[5] = limits.motor_softness;
  rows.lower = -limits.motor_force;
  rows.upper = limits.motor_force;
}

/// Row 5 at a stop replaces the motor's row; the motor presses into the stop with its full force.
///     c = -(erp/h) (position - stop), or -bounce * velocity if that leaves the stop faster
void setStopRow(const AxisLimits& limits, double position, double velocity_before, double k, JointRows& rows) {
  const bool low = rows.contact == AxisContact::low_stop;
  const bool locked = rows.contact == AxisContact::locked;
  rows.velocity[5] = -k * (position - (low || locked ? limits.low_stop : limits.high_stop));
  rows.softness[5] = limits.stop_softness;
  rows.lower = low ? 0 : -dInfinity;
  rows.upper = low || locked ? dInfinity : 0;
  if (locked) return;
  if (limits.motor_force > 0 && limits.motor_force < dInfinity) {
    const double v = limits.motor_velocity;
    const bool away = low ? v > 0 : v < 0;
    const double direction = v > 0 || (v == 0 && !low) ? 1 : -1;
    rows.constant_force = direction * limits.motor_force * (away ? limits.fudge_ratio : 1);
  }
  const double rebound = -limits.bounce_ratio * velocity_before;
  if (limits.bounce_ratio > 0 && low && velocity_before < 0) rows.velocity[5] = std::max(rows.velocity[5], rebound);
  if (limits.bounce_ratio > 0 && !low && velocity_before > 0) rows.velocity[5] = std::min(rows.velocity[5], rebound);
}

void setAxisRow(const JointModel& joint, const Pair& pair, double h_s, const ErrorReduction& reduction, double position, bool has_stops,
                JointRows& rows) {
  const AxisLimits& limits = joint.limits;
  rows.constant_force = 0;
  rows.contact = stopAt(limits, position, has_stops);
  rows.row_count = rows.contact == AxisContact::none ? 5 : 6;
  if (rows.contact == AxisContact::none) return;
  if (rows.contact == AxisContact::motor) return setMotorRow(limits, rows);
  setStopRow(limits, position, axisVelocity(pair, rows, joint.kind == Joint::Kind::hinge), reduction.of(limits.stop_reduction) / h_s, rows);
}

/// Slider: both bodies keep the same orientation (3 rows), and the second body's offset point stays on the axis through the first (2 rows);
/// the last row acts along the axis. If both bodies move, a row along d is
///     d . (v1 - v2) + 1/2 (c x d) . (w1 + w2),   c = x2 - x1,
/// for d perpendicular to or along the axis, so that a force along d exerts no torque on the pair.
void setSliderRows(const JointModel& joint, const Pair& pair, double h_s, const ErrorReduction& reduction, JointRows& rows) {
  const double k = reduction.of(joint.reduction) / h_s;
  setOrientationRows(joint, pair, k, 0, rows);
  Vector d[3];
  d[2] = pair.first.rotation * joint.reference.axis[0];
  planeAcross(d[2], d[0], d[1]);
  const Vector error = pair.second.position + pair.second.rotation * joint.reference.offset - pair.first.position;
  const Vector half_lever = 0.5 * (pair.second.position - pair.first.position);
  for (int i = 0; i < 3; ++i) {
    const Vector torque = pair.has_second ? Vector(half_lever.cross(d[i])) : Vector::Zero();
    setRow(rows, 0, 3 + i, d[i], torque);
    if (pair.has_second) setRow(rows, 1, 3 + i, -d[i], torque);
    if (i < 2) rows.velocity[3 + i] = k * d[i].dot(error);
  }
  const bool has_stops = joint.limits.low_stop > -dInfinity || joint.limits.high_stop < dInfinity;
  setAxisRow(joint, pair, h_s, reduction, -d[2].dot(error), has_stops, rows);
}

/// Angle of a hinge, -pi .. pi, from the rotation about the axis seen from the first body.
double hingeAngle(const Quaternion& turn, const Vector& axis) {
  const double sine = turn.tail<3>().norm();
  double angle = turn.tail<3>().dot(axis) >= 0 ? 2 * std::atan2(sine, turn[0]) : 2 * std::atan2(sine, -turn[0]);
  if (angle > pi) angle -= 2 * pi;
  return -angle;
}

/// Hinge: both bodies keep a common anchor (3 rows), and their axes stay parallel (2 rows); the last row is axis . (w1 - w2).
void setHingeRows(const JointModel& joint, const Pair& pair, double h_s, const ErrorReduction& reduction, JointRows& rows) {
  const double k = reduction.of(joint.reduction) / h_s;
  setAnchorRows(joint, pair, k, rows);
  Vector d[3];
  d[2] = pair.first.rotation * joint.reference.axis[0];
  planeAcross(d[2], d[0], d[1]);
  const Vector error = d[2].cross(pair.second.rotation * joint.reference.axis[1]);
  for (int i = 0; i < 3; ++i) {
    setRow(rows, 0, 3 + i, Vector::Zero(), d[i]);
    if (pair.has_second) setRow(rows, 1, 3 + i, Vector::Zero(), -d[i]);
    if (i < 2) rows.velocity[3 + i] = k * d[i].dot(error);
  }
  const AxisLimits& limits = joint.limits;
  const bool has_stops = (limits.low_stop >= -pi || limits.high_stop <= pi) && limits.low_stop <= limits.high_stop;
  const double angle = has_stops ? hingeAngle(turnOf(joint, pair), joint.reference.axis[0]) : 0;
  setAxisRow(joint, pair, h_s, reduction, angle, has_stops, rows);
}

/// Fixed to the environment: position and orientation stay as registered.
void setFixedRows(const JointModel& joint, const Pair& pair, double k, JointRows& rows) {
  for (int i = 0; i < 3; ++i) {
    rows.jacobian[0][i][i] = 1;
    rows.velocity[i] = k * (joint.reference.offset[i] - pair.first.position[i]);
  }
  setOrientationRows(joint, pair, k, 3, rows);
}

}  // namespace

int JointModel::positionRowCount() const {
  return kind == Joint::Kind::ball ? 3 : kind == Joint::Kind::fixed ? 6 : 5;
}

namespace {

/// A parameter that ODE stores for a slider or hinge.
double parameterOf(const JointModel& joint, int which) {
  const dJointID id = joint.joint->id();
  return joint.kind == Joint::Kind::slider ? dJointGetSliderParam(id, which) : dJointGetHingeParam(id, which);
}

}  // namespace

void JointModel::readLimits() {
  if (kind != Joint::Kind::slider && kind != Joint::Kind::hinge) return;
  limits.low_stop = parameterOf(*this, dParamLoStop);
  limits.high_stop = parameterOf(*this, dParamHiStop);
  readMotor();
}

void JointModel::readMotor() {
  limits.motor_force = parameterOf(*this, dParamFMax);
}

void JointModel::readAxis() {
  if (kind != Joint::Kind::slider && kind != Joint::Kind::hinge) return;
  readLimits();
  limits.motor_velocity = parameterOf(*this, dParamVel);
  limits.fudge_ratio = parameterOf(*this, dParamFudgeFactor);
  limits.bounce_ratio = parameterOf(*this, dParamBounce);
  limits.motor_softness = parameterOf(*this, dParamCFM);
  limits.stop_softness = parameterOf(*this, dParamStopCFM);
  limits.stop_reduction = parameterOf(*this, dParamStopERP);
}

JointModel registerJoint(const Joint& joint, const BodyState& bodies) {
  JointModel model;
  model.joint = &joint;
  model.kind = joint.kind();
  model.reference = joint.reference();
  model.separation = -(matrixOf(model.reference.rotation) * model.reference.offset);
  const dJointID id = joint.id();
  for (int i = 0; i < 2; ++i) model.body[i] = dJointGetBody(id, i) ? bodies.find(dJointGetBody(id, i)) : -1;
  const dWorldID world = dBodyGetWorld(dJointGetBody(id, 0));
  model.reduction = dWorldGetERP(world);
  model.softness = dWorldGetCFM(world);
  if (model.kind == Joint::Kind::ball) {
    model.reduction = dJointGetBallParam(id, dParamERP);
    model.softness = dJointGetBallParam(id, dParamCFM);
  } else if (model.kind == Joint::Kind::fixed) {
    model.reduction = dJointGetFixedParam(id, dParamERP);
    model.softness = dJointGetFixedParam(id, dParamCFM);
  } else {
    model.readAxis();
  }
  return model;
}

void makeRows(const JointModel& joint, const BodyState& bodies, double h_s, const ErrorReduction& reduction, JointRows& rows) {
  const Pair pair = bodiesOf(joint, bodies);
  rows.row_count = joint.positionRowCount();
  for (int i = 0; i < rows.row_count; ++i) rows.softness[i] = joint.softness;
  switch (joint.kind) {
    case Joint::Kind::slider:
      return setSliderRows(joint, pair, h_s, reduction, rows);
    case Joint::Kind::hinge:
      return setHingeRows(joint, pair, h_s, reduction, rows);
    case Joint::Kind::fixed:
      return setFixedRows(joint, pair, reduction.of(joint.reduction) / h_s, rows);
    default:
      return setAnchorRows(joint, pair, reduction.of(joint.reduction) / h_s, rows);
  }
}

double gapOf(const JointModel& joint, const BodyState& bodies) {
  const Pair pair = bodiesOf(joint, bodies);
  if (joint.kind == Joint::Kind::ball || joint.kind == Joint::Kind::hinge)
    return (pair.first.position + pair.first.rotation * joint.reference.anchor[0] - pair.second.position -
            pair.second.rotation * joint.reference.anchor[1])
        .norm();
  const Vector moved = pair.first.rotation.transpose() * (pair.second.position - pair.first.position) - joint.separation;
  if (joint.kind == Joint::Kind::fixed) return moved.norm();
  const Vector& axis = joint.reference.axis[0];
  return (moved - axis * axis.dot(moved)).norm();
}

}  // namespace musclesim::chain
