#include "bone_mobility.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>

#include "../robot/ode_vector.h"

namespace musclesim {

namespace {

constexpr double turn_scale_mm = 100;  ///< lever that weights the rows on angles against the rows on points

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// diag(1/m, (R I R^T)^-1)
Matrix6 inverseInertia(dBodyID body) {
  dMass mass;
  dBodyGetMass(body, &mass);
  const Eigen::Matrix3d turn = rotationOf(body);
  Matrix6 inverse = Matrix6::Zero();
  inverse.topLeftCorner<3, 3>().diagonal().setConstant(1 / mass.mass);
  inverse.bottomRightCorner<3, 3>() = turn * matrixFromOde(mass.I).inverse() * turn.transpose();
  return inverse;
}

/// What a joint constrains: the motion of a point along some directions and the rotation about some directions (columns, world frame).
struct Hold {
  Vector point;
  Eigen::Matrix3Xd along, about;
};

/// Two directions perpendicular to an axis.
Eigen::Matrix3Xd across(const Vector& axis) {
  Eigen::Matrix3Xd directions(3, 2);
  directions.col(0) = axis.unitOrthogonal();
  directions.col(1) = axis.cross(directions.col(0));
  return directions;
}

Hold holdOf(const Joint& joint) {
  const dJointID id = joint.id();
  const Eigen::Matrix3Xd all = Eigen::Matrix3d::Identity(), none(3, 0);
  dVector3 point, axis;
  switch (joint.kind()) {
    case Joint::Kind::ball:
      dJointGetBallAnchor(id, point);
      return {fromOde(point), all, none};
    case Joint::Kind::hinge:
      dJointGetHingeAnchor(id, point);
      dJointGetHingeAxis(id, axis);
      return {fromOde(point), all, across(fromOde(axis))};
    case Joint::Kind::hinge2:
      dJointGetHinge2Anchor(id, point);
      return {fromOde(point), all, none};
    case Joint::Kind::universal:
      dJointGetUniversalAnchor(id, point);
      return {fromOde(point), all, none};
    case Joint::Kind::slider:
      dJointGetSliderAxis(id, axis);
      return {positionOf(dJointGetBody(id, 0)), across(fromOde(axis)), all};
    case Joint::Kind::fixed:
      return {positionOf(dJointGetBody(id, 0)), all, all};
  }
  return {};
}

}  // namespace

BoneMobility::BoneMobility(const std::vector<std::unique_ptr<Joint>>& joints, const std::vector<dBodyID>& left_out) {
  const auto isLeftOut = [&](dBodyID body) { return body && std::binary_search(left_out.begin(), left_out.end(), body); };
  std::vector<const Joint*> held;
  for (const auto& joint : joints) {
    const dBodyID ends[2] = {dJointGetBody(joint->id(), 0), dJointGetBody(joint->id(), 1)};
    if (!ends[0] || isLeftOut(ends[0]) || isLeftOut(ends[1])) continue;
    held.push_back(joint.get());
    for (const dBodyID body : ends)
      if (body && placeOf(body) < 0) bodies_.push_back(body);
  }

  const auto unknowns = 6 * static_cast<Eigen::Index>(bodies_.size());
  mobility_.setZero(unknowns, unknowns);
  for (const dBodyID body : bodies_) mobility_.block<6, 6>(placeOf(body), placeOf(body)) = inverseInertia(body);

  Eigen::MatrixXd rows(6 * static_cast<Eigen::Index>(held.size()), unknowns);  // G
  rows.setZero();
  Eigen::Index row = 0;
  for (const Joint* joint : held) {
    const Hold hold = holdOf(*joint);
    for (int end = 0; end < 2; ++end) {
      const dBodyID body = dJointGetBody(joint->id(), end);
      if (!body) continue;
      const Eigen::Index place = placeOf(body);
      const double sign = end == 0 ? 1 : -1;
      const Vector arm = hold.point - positionOf(body);
      for (Eigen::Index i = 0; i < hold.along.cols(); ++i) {
        rows.block<1, 3>(row + i, place) = sign * hold.along.col(i).transpose();
        rows.block<1, 3>(row + i, place + 3) = sign * arm.cross(hold.along.col(i)).transpose();
      }
      for (Eigen::Index i = 0; i < hold.about.cols(); ++i)
        rows.block<1, 3>(row + hold.along.cols() + i, place + 3) = sign * turn_scale_mm * hold.about.col(i).transpose();
    }
    row += hold.along.cols() + hold.about.cols();
  }
  if (row == 0) return;
  const Eigen::MatrixXd held_motion = rows.topRows(row) * mobility_;  // G W
  mobility_ -= held_motion.transpose() * (held_motion * rows.topRows(row).transpose()).completeOrthogonalDecomposition().solve(held_motion);
}

Eigen::Index BoneMobility::placeOf(dBodyID body) const {
  const auto found = std::ranges::find(bodies_, body);
  return found != bodies_.end() ? 6 * (found - bodies_.begin()) : -1;
}

double BoneMobility::between(const std::vector<LineOfPull::Push>& a, const std::vector<LineOfPull::Push>& b) const {
  double sum = 0;
  for (const auto& first : a)
    for (const auto& second : b) {
      Eigen::Matrix<double, 6, 1> pull, push;
      pull << first.force, first.torque;
      push << second.force, second.torque;
      const Eigen::Index from = placeOf(second.body), to = placeOf(first.body);
      if (from >= 0 && to >= 0)
        sum += pull.dot(mobility_.block<6, 6>(to, from) * push);
      else if (first.body == second.body)
        sum += pull.dot(inverseInertia(first.body) * push);
    }
  return sum;
}

}  // namespace musclesim
