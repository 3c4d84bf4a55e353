#include "skeleton.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/primitive.h"
#include "ode_vector.h"

namespace musclesim {

namespace {

const Eigen::Matrix3d environment_rotation = Eigen::Matrix3d::Identity();

Eigen::Matrix3d rotationAbout(const Vector& axis, double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

/// A rotation vector has the direction of the axis and the length of the angle in rad.
Eigen::AngleAxisd rotationOfVector(const Vector& rotation_vector) {
  const double angle_rad = rotation_vector.norm();
  return angle_rad > 0 ? Eigen::AngleAxisd(angle_rad, rotation_vector / angle_rad) : Eigen::AngleAxisd(0, Vector::UnitX());
}

std::string nameOf(const Body& body) {
  return body.parts.empty() ? "a body" : body.parts.front()->name();
}

bool isBead(const World& world, dBodyID id) {
  return id && std::ranges::none_of(world.bodies(), [&](const auto& body) { return body->id == id; });
}

/// The joints between bodies, and between bodies and the environment.
std::vector<const Joint*> jointsOfBones(const World& world) {
  std::vector<const Joint*> joints;
  for (const auto& joint : world.joints())
    if (!isBead(world, dJointGetBody(joint->id(), 0)) && !isBead(world, dJointGetBody(joint->id(), 1))) joints.push_back(joint.get());
  return joints;
}

/// Stops in the unit of the coordinate.
std::pair<double, double> stopsOf(const Joint& joint, int axis) {
  if (joint.kind() == Joint::Kind::ball) return {-dInfinity, dInfinity};
  if (joint.kind() == Joint::Kind::slider)
    return {dJointGetSliderParam(joint.id(), dParamLoStop), dJointGetSliderParam(joint.id(), dParamHiStop)};
  const auto [low_deg, high_deg] = joint.stopsDeg(axis);
  return {low_deg * rad_per_deg, high_deg * rad_per_deg};
}

}  // namespace

std::string Coordinate::name() const {
  const bool only = joint->kind() == Joint::Kind::hinge || joint->kind() == Joint::Kind::slider;
  return only ? joint->name() : fmt::format("axis {} of {}", axis, joint->name());
}

Skeleton::Skeleton(const World& world, Loops loops) {
  addBones(world, loops);
  setPose(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coordinates_.size())));
}

/// From the environment outwards: every round hangs bodies on those that already hang.
void Skeleton::addBones(const World& world, Loops loops) {
  std::vector<const Joint*> waiting = jointsOfBones(world);
  const auto bodyOf = [&](dBodyID id) -> const Body& {
    return **std::ranges::find_if(world.bodies(), [&](const auto& body) { return body->id == id; });
  };
  const auto isHeld = [&](dBodyID id) { return !id || numberOf(id) >= 0; };
  for (bool growing = true; growing;) {
    growing = false;
    std::vector<const Joint*> later;
    for (const Joint* joint : waiting) {
      const dBodyID first = dJointGetBody(joint->id(), 0), second = dJointGetBody(joint->id(), 1);
      if (isHeld(first) && isHeld(second) && loops == Loops::opened && joint->kind() == Joint::Kind::ball) {
        closures_.push_back(joint);
        continue;
      }
      if (isHeld(first) && isHeld(second))
        throw BadParameter(joint->name() + " closes a loop of joints; robots settle only if their joints form a tree");
      if (!isHeld(first) && !isHeld(second)) {
        later.push_back(joint);
        continue;
      }
      const dBodyID hanging = isHeld(first) ? second : first;
      bones_.push_back(boneOn(*joint, bodyOf(hanging), numberOf(hanging == first ? second : first)));
      growing = true;
    }
    waiting = std::move(later);
  }
  for (const auto& body : world.bodies())
    if (numberOf(body->id) < 0)
      throw BadParameter(nameOf(*body) +
                         " is free: no joint, directly or over other bodies, holds it to the environment, so the pose in "
                         "which it would rest is not determined");
}

Skeleton::Bone Skeleton::boneOn(const Joint& joint, const Body& body, int parent) {
  const JointReference& reference = joint.reference();
  const Eigen::Vector4d& w = reference.rotation;
  const Eigen::Matrix3d second_in_first = Eigen::Quaterniond(w[0], w[1], w[2], w[3]).toRotationMatrix();
  const bool is_first = dJointGetBody(joint.id(), 0) == body.id;
  dMass mass;
  dBodyGetMass(body.id, &mass);
  Bone bone = {};
  bone.body = &body;
  bone.mass_g = mass.mass;
  bone.parent = parent;
  bone.joint = &joint;
  bone.anchor = reference.anchor[is_first ? 1 : 0];
  bone.anchor_in_bone = reference.anchor[is_first ? 0 : 1];
  if (is_first) {
    bone.turn = second_in_first.transpose();
    bone.offset = reference.offset;
  } else {
    bone.turn = second_in_first;
    bone.offset = -(second_in_first * reference.offset);
  }
  addCoordinates(bone, is_first);
  return bone;
}

/// Coordinates measure the motion of the joint's first body against the second.
void Skeleton::addCoordinates(Bone& bone, bool is_first) {
  const JointReference& reference = bone.joint->reference();
  const Joint::Kind kind = bone.joint->kind();
  const double sign = is_first ? 1 : -1;
  const Eigen::Matrix3d first_to_parent = is_first ? bone.turn : environment_rotation;
  const Eigen::Matrix3d second_to_parent = is_first ? environment_rotation : bone.turn;
  bone.first_coordinate = static_cast<int>(coordinates_.size());
  switch (kind) {
    case Joint::Kind::fixed:
      break;
    case Joint::Kind::hinge:
    case Joint::Kind::slider:
      bone.coordinate_count = 1;
      bone.axis[0] = sign * (first_to_parent * reference.axis[0]);
      break;
    case Joint::Kind::universal:
    case Joint::Kind::hinge2: {
      // The axis that is fixed to the parent comes first.
      bone.coordinate_count = 2;
      const Vector axes[2] = {sign * (first_to_parent * reference.axis[0]), sign * (second_to_parent * reference.axis[1])};
      for (int i = 0; i < 2; ++i) {
        bone.coordinate_of_axis[i] = is_first ? 1 - i : i;
        bone.axis[i] = axes[bone.coordinate_of_axis[i]];
      }
      break;
    }
    case Joint::Kind::ball:
      bone.coordinate_count = 3;
      for (int i = 0; i < 3; ++i) {
        bone.coordinate_of_axis[i] = i;
        bone.axis[i] = Vector::Unit(i);
      }
      break;
  }
  for (int i = 0; i < bone.coordinate_count; ++i) {
    const auto [low, high] = stopsOf(*bone.joint, i);
    coordinates_.push_back({bone.joint, i, kind != Joint::Kind::slider, low, high});
  }
}

Eigen::VectorXd Skeleton::displaced(const Eigen::VectorXd& coordinates, const Eigen::VectorXd& by) const {
  Eigen::VectorXd result = coordinates + by;
  for (const Bone& bone : bones_) {
    if (bone.joint->kind() != Joint::Kind::ball) continue;
    const Vector before = coordinates.segment<3>(bone.first_coordinate), turn = by.segment<3>(bone.first_coordinate);
    const Eigen::AngleAxisd after(rotationOfVector(turn) * rotationOfVector(before));
    result.segment<3>(bone.first_coordinate) = after.angle() * after.axis();
  }
  return result;
}

void Skeleton::setPose(const Eigen::VectorXd& coordinates) {
  for (Bone& bone : bones_) setPose(bone, coordinates);
}

void Skeleton::setPose(Bone& bone, const Eigen::VectorXd& coordinates) const {
  const Bone* parent = bone.parent >= 0 ? &bones_[static_cast<std::size_t>(bone.parent)] : nullptr;
  const Eigen::Matrix3d& base = parent ? parent->rotation : environment_rotation;
  const Joint::Kind kind = bone.joint->kind();
  Eigen::Matrix3d moved = base;  // the parent's frame, turned by the joint
  Vector offset = bone.offset;
  if (kind == Joint::Kind::ball) {
    for (int i = 0; i < 3; ++i) bone.axis_now[i] = base.col(i);
    moved = base * rotationOfVector(coordinates.segment<3>(bone.first_coordinate)).toRotationMatrix();
  } else if (kind == Joint::Kind::slider) {
    bone.axis_now[0] = base * bone.axis[0];
    offset += coordinates[bone.first_coordinate] * bone.axis[0];
  } else {
    for (int i = 0; i < bone.coordinate_count; ++i) {
      bone.axis_now[i] = moved * bone.axis[i];
      moved = moved * rotationAbout(bone.axis[i], coordinates[bone.first_coordinate + bone.coordinate_of_axis[i]]);
    }
  }
  bone.rotation = moved * bone.turn;
  bone.anchor_now = parent ? Vector(parent->position + base * bone.anchor) : bone.anchor;
  if (kind == Joint::Kind::slider || kind == Joint::Kind::fixed)
    bone.position = parent ? Vector(parent->position + base * offset) : offset;
  else
    bone.position = bone.anchor_now - bone.rotation * bone.anchor_in_bone;
}

void Skeleton::placeBodies() const {
  for (const Bone& bone : bones_) {
    dBodySetPosition(bone.body->id, bone.position.x(), bone.position.y(), bone.position.z());
    setRotation(bone.body->id, bone.rotation);
  }
}

int Skeleton::numberOf(dBodyID id) const {
  for (std::size_t i = 0; i < bones_.size(); ++i)
    if (bones_[i].body->id == id) return static_cast<int>(i);
  return -1;
}

Vector Skeleton::pointMm(int number, const Vector& place) const {
  if (number < 0) return place;
  const Bone& bone = bones_[static_cast<std::size_t>(number)];
  return bone.position + bone.rotation * place;
}

void Skeleton::loadWithWeights(const Vector& gravity) {
  for (Bone& bone : bones_) {
    bone.force_N = bone.mass_g * gravity;
    bone.torque_Nmm = bone.position.cross(bone.force_N);
  }
}

void Skeleton::addForce(int number, const Vector& force_N, const Vector& point_mm) {
  if (number < 0) return;
  Bone& bone = bones_[static_cast<std::size_t>(number)];
  bone.force_N += force_N;
  bone.torque_Nmm += point_mm.cross(force_N);
}

void Skeleton::addLoad(int number, const BodyLoad& load) {
  if (number < 0) return;
  Bone& bone = bones_[static_cast<std::size_t>(number)];
  bone.force_N += load.force_N;
  bone.torque_Nmm += load.torque_Nmm + bone.position.cross(load.force_N);
}

/// From the tips inwards: a coordinate moves its body and all that hangs on it.
void Skeleton::takeForces(Eigen::VectorXd& generalised) {
  for (std::size_t n = bones_.size(); n-- > 0;) {
    const Bone& bone = bones_[n];
    const bool slides = bone.joint->kind() == Joint::Kind::slider;
    const Vector torque_Nmm = bone.torque_Nmm - bone.anchor_now.cross(bone.force_N);
    for (int i = 0; i < bone.coordinate_count; ++i)
      generalised[bone.first_coordinate + bone.coordinate_of_axis[i]] = bone.axis_now[i].dot(slides ? bone.force_N : torque_Nmm);
    if (bone.parent < 0) continue;
    Bone& parent = bones_[static_cast<std::size_t>(bone.parent)];
    parent.force_N += bone.force_N;
    parent.torque_Nmm += bone.torque_Nmm;
  }
}

}  // namespace musclesim
