#include "contact_set.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "../../robot/ode_vector.h"

namespace musclesim::chain {

namespace {

void setRow(ContactRows& contact, int row, const Vector& direction, const Vector& point, const BodyState& bodies) {
  for (int side = 0; side < 2; ++side) {
    double* j = contact.jacobian[side][row];
    if (contact.body[side] < 0) {
      std::fill_n(j, 6, 0.0);
      continue;
    }
    const Vector along = side == 0 ? direction : -direction;
    const Vector torque = (point - bodies[contact.body[side]].position).cross(along);
    for (int i = 0; i < 3; ++i) {
      j[i] = along[i];
      j[3 + i] = torque[i];
    }
  }
}

double velocityAlong(const ContactRows& contact, int row, const BodyState& bodies) {
  double sum = 0;
  for (int side = 0; side < 2; ++side) {
    const BodyMotion& motion = bodies[contact.body[side]];
    for (int i = 0; i < 3; ++i)
      sum += contact.jacobian[side][row][i] * motion.velocity[i] + contact.jacobian[side][row][3 + i] * motion.spin[i];
  }
  return sum;
}

}  // namespace

bool ContactSet::make(const std::vector<ContactPoint>& points, const BodyState& bodies, double friction_force, double reduction_per_s) {
  std::swap(contacts_, before_);
  contacts_.clear();
  for (const ContactPoint& point : points) {
    // ODE swaps the bodies if the first is the environment.
    const bool exchanged = !point.body[0];
    ContactRows contact = {};
    for (int side = 0; side < 2; ++side) {
      const dBodyID id = point.body[exchanged ? 1 - side : side];
      contact.body[side] = id ? bodies.find(id) : -1;
      if (id && contact.body[side] < 0) return false;
    }
    if (contact.body[0] < 0) continue;
    const Vector normal = exchanged ? -fromOde(point.geometry.normal) : fromOde(point.geometry.normal);
    const dVector3 n = {normal.x(), normal.y(), normal.z()};
    dVector3 t1, t2;
    dPlaneSpace(n, t1, t2);
    const Vector place = fromOde(point.geometry.pos);
    contact.row_count = friction_force > 0 ? 3 : 1;
    setRow(contact, 0, normal, place, bodies);
    setRow(contact, 1, fromOde(t1), place, bodies);
    setRow(contact, 2, fromOde(t2), place, bodies);
    contact.velocity[0] = reduction_per_s * std::max(0.0, point.geometry.depth);
    contact.upper[0] = dInfinity;
    for (int row = 1; row < 3; ++row) {
      contact.lower[row] = -friction_force;
      contact.upper[row] = friction_force;
    }
    warmStart(contact, bodies);
    contacts_.push_back(contact);
  }
  linkBodies(bodies.count());
  return true;
}

void ContactSet::linkBodies(int body_count) {
  last_.assign(static_cast<std::size_t>(body_count), -1);
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    for (int side = 0; side < 2; ++side) {
      contacts_[i].before[side] = -1;
      if (contacts_[i].body[side] < 0) continue;
      int& last = last_[static_cast<std::size_t>(contacts_[i].body[side])];
      contacts_[i].before[side] = last;
      last = static_cast<int>(i);
    }
}

/// Takes the states of the contact between the same bodies in the last step. A new contact starts as pressing, and as sliding in the
/// direction in which its bodies move.
void ContactSet::warmStart(ContactRows& contact, const BodyState& bodies) const {
  const auto same = std::find_if(before_.begin(), before_.end(), [&](const ContactRows& other) {
    return other.body[0] == contact.body[0] && other.body[1] == contact.body[1];
  });
  if (same != before_.end()) {
    std::copy_n(same->state, 3, contact.state);
    return;
  }
  contact.state[0] = RowState::free;
  for (int row = 1; row < 3; ++row) contact.state[row] = velocityAlong(contact, row, bodies) > 0 ? RowState::at_lower : RowState::at_upper;
}

}  // namespace musclesim::chain
