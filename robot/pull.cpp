#include "musclesim/robot/pull.h"

#include <fmt/format.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/primitive.h"
#include "musclesim/robot/world.h"
#include "ode_vector.h"

namespace musclesim {

namespace {

constexpr double stiffness_N_per_mm = 0.5;   ///< a hand 100 mm away pulls with 50 N, as much as a muscle
constexpr double damping_Ns_per_mm = 0.005;  ///< keeps a held body of 100 g from swinging
constexpr double strongest_N = 100;          ///< a pull across the whole window shall not tear the robot apart

const Primitive& heldPart(const World& world, const Pull& pull) {
  if (pull.part >= world.primitives().size())
    throw BadParameter("part of a pull", fmt::format("{}", pull.part), fmt::format("be below {}", world.primitives().size()));
  return *world.primitives()[pull.part];
}

}  // namespace

PullForce pullForce(const World& world, const Pull& pull) {
  const Primitive& part = heldPart(world, pull);
  const Vector point = fromOde(dGeomGetPosition(part.geom())) + turned(pull.point_mm, dGeomGetRotation(part.geom()));
  dVector3 velocity;
  dBodyGetPointVel(part.body().id, point.x(), point.y(), point.z(), velocity);
  const double speed_ratio = std::sqrt(world.physics().force_per_N / world_force_per_N);
  Vector force = stiffness_N_per_mm * (pull.towards_mm - point) - damping_Ns_per_mm / speed_ratio * fromOde(velocity);
  if (const double size_N = force.norm(); size_N > strongest_N) force *= strongest_N / size_N;
  return {point, force};
}

void applyPull(const World& world, const Pull& pull) {
  const auto [point, force_N] = pullForce(world, pull);
  const Vector force = force_N * world.physics().force_per_N;
  dBodyAddForceAtPos(heldPart(world, pull).body().id, force.x(), force.y(), force.z(), point.x(), point.y(), point.z());
}

}  // namespace musclesim
