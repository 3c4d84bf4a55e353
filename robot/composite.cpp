/// Mass properties of bodies of several parts, and of bodies that carry point masses.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "musclesim/base/error.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/primitive.h"
#include "ode_vector.h"
#include "vector_checks.h"

namespace musclesim {

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

void Primitive::setInertia(const Vector& moments_g_mm2) {
  if (!(moments_g_mm2.minCoeff() > 0) || !moments_g_mm2.allFinite())
    throw BadParameter("moments of inertia of " + name_ + " must be positive");
  dMass mass;
  dBodyGetMass(body_->id, &mass);
  dMassSetParameters(&mass, mass.mass, 0, 0, 0, moments_g_mm2.x(), moments_g_mm2.y(), moments_g_mm2.z(), 0, 0, 0);
  dBodySetMass(body_->id, &mass);
}

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
  takeMassProperties(total_g, center, inertia);
}

void Primitive::setMassProperties(double mass_g, const Vector& center_mm, const Eigen::Matrix3d& inertia) {
  requireFinite("centre of mass of " + name_, center_mm);
  if (!(mass_g > 0) || !std::isfinite(mass_g))
    throw BadParameter("mass of " + name_, fmt::format("{} g", mass_g), "be positive and finite");
  if (!inertia.allFinite()) throw BadParameter("moments of inertia of " + name_ + " must be finite");
  const Vector principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();  // in ascending order
  // Files give four digits or so: a flat body may miss the limit by their rounding.
  constexpr double rounding_ratio = 1e-3;
  if (!(principal[0] > 0) || principal[2] > (principal[0] + principal[1]) * (1 + rounding_ratio))
    throw BadParameter("principal moments of inertia of " + name_,
                       fmt::format("{:.4g}, {:.4g}, {:.4g} g mm^2", principal[0], principal[1], principal[2]),
                       "be positive, and the largest at most the sum of the two others: no body has others");
  takeMassProperties(mass_g, center_mm, inertia);
}

/// Moves the centre of mass to another point of the body: joints and shapes stay where they are in the world.
void Primitive::takeMassProperties(double mass_g, const Vector& center, const Eigen::Matrix3d& inertia) {
  dMass mass;
  dMassSetParameters(&mass, mass_g, 0, 0, 0, inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2));
  dBodySetMass(body_->id, &mass);
  if (center == getPosition()) return;
  const Vector moved_mm = getRotation().transpose() * (center - getPosition());
  std::vector<std::pair<Joint*, Vector>> joints;
  for (const auto& joint : world_.joints())
    if (dJointGetBody(joint->id(), 0) == body_->id || dJointGetBody(joint->id(), 1) == body_->id)
      joints.emplace_back(joint.get(), anchorOf(*joint));
  std::vector<Vector> drawn;
  for (const Primitive* part : body_->parts) drawn.push_back(fromOde(dGeomGetPosition(part->geom_)));
  dBodySetPosition(body_->id, center.x(), center.y(), center.z());
  for (std::size_t i = 0; i < drawn.size(); ++i)
    dGeomSetOffsetWorldPosition(body_->parts[i]->geom_, drawn[i].x(), drawn[i].y(), drawn[i].z());
  for (const auto& [joint, anchor] : joints) reattach(*joint, anchor);
  for (Actuator* actuator : world_.actuators()) actuator->moveCenter(body_->id, moved_mm);
  for (const auto& element : world_.forceElements()) element->moveCenter(body_->id, moved_mm);
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

}  // namespace musclesim
