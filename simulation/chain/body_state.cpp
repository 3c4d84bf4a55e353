#include "body_state.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "../../robot/ode_vector.h"

namespace musclesim::chain {

void BodyState::clear() {
  ids_.clear();
  motions_.assign(
      1, {Vector::Zero(), {1, 0, 0, 0}, Eigen::Matrix3d::Identity(), Vector::Zero(), Vector::Zero(), Vector::Zero(), Vector::Zero()});
  sorted_.clear();
}

int BodyState::add(dBodyID id) {
  ids_.push_back(id);
  motions_.emplace_back();
  return count() - 1;
}

void BodyState::sort() {
  sorted_.clear();
  for (int body = 0; body < count(); ++body) sorted_.push_back({id(body), body});
  std::sort(sorted_.begin(), sorted_.end(), [](const Entry& a, const Entry& b) { return std::less<>()(a.id, b.id); });
}

int BodyState::find(dBodyID id) const {
  const auto place =
      std::lower_bound(sorted_.begin(), sorted_.end(), id, [](const Entry& e, dBodyID sought) { return std::less<>()(e.id, sought); });
  return place != sorted_.end() && place->id == id ? place->body : -1;
}

void BodyState::gather() {
  for (int body = 0; body < count(); ++body) {
    const dBodyID id = ids_[static_cast<std::size_t>(body)];
    BodyMotion& motion = (*this)[body];
    const dReal* q = dBodyGetQuaternion(id);
    motion.position = fromOde(dBodyGetPosition(id));
    motion.quaternion = Quaternion(q[0], q[1], q[2], q[3]);
    motion.rotation = matrixFromOde(dBodyGetRotation(id));
    motion.velocity = fromOde(dBodyGetLinearVel(id));
    motion.spin = fromOde(dBodyGetAngularVel(id));
    motion.force = fromOde(dBodyGetForce(id));
    motion.torque = fromOde(dBodyGetTorque(id));
  }
}

void BodyState::integrate(double h_s, const std::vector<Vector6>& u, const BodyBounds& bounds) {
  for (int body = 0; body < count(); ++body) {
    BodyMotion& motion = (*this)[body];
    const Vector6& new_velocity = u[static_cast<std::size_t>(body)];
    motion.velocity = h_s * new_velocity.head<3>();
    motion.spin = h_s * new_velocity.tail<3>();
    motion.position += h_s * motion.velocity;
    bounds.require(id(body), motion.position, motion.velocity);
    const Quaternion spin(0, motion.spin.x(), motion.spin.y(), motion.spin.z());
    motion.quaternion += 0.5 * h_s * product(spin, motion.quaternion);
    motion.quaternion /= std::sqrt(motion.quaternion.squaredNorm());
    motion.rotation = matrixOf(motion.quaternion);
  }
}

/// Leaves out bodies whose pose is unchanged to the bit: setting a pose makes ODE recompute the placement of the body's geoms.
void BodyState::scatter() const {
  for (int body = 0; body < count(); ++body) {
    const dBodyID id = ids_[static_cast<std::size_t>(body)];
    const BodyMotion& motion = (*this)[body];
    const Vector &x = motion.position, &v = motion.velocity, &w = motion.spin;
    const dQuaternion q = {motion.quaternion[0], motion.quaternion[1], motion.quaternion[2], motion.quaternion[3]};
    if (!std::equal(x.data(), x.data() + 3, dBodyGetPosition(id))) dBodySetPosition(id, x.x(), x.y(), x.z());
    if (!std::equal(q, q + 4, dBodyGetQuaternion(id))) dBodySetQuaternion(id, q);
    dBodySetLinearVel(id, v.x(), v.y(), v.z());
    dBodySetAngularVel(id, w.x(), w.y(), w.z());
    dBodySetForce(id, 0, 0, 0);
    dBodySetTorque(id, 0, 0, 0);
  }
}

}  // namespace musclesim::chain
