/// A pull at a body from outside, as by a hand that holds a spring.
#pragma once

#include <cstddef>

#include "musclesim/robot/state.h"

namespace musclesim {

class World;

/// Where a hand holds a primitive, and where the hand is.
struct Pull {
  std::size_t part = 0;                ///< number in World::primitives()
  Vector point_mm = Vector::Zero();    ///< where the primitive is held, in its own frame
  Vector towards_mm = Vector::Zero();  ///< where the hand is, world frame
  bool operator==(const Pull&) const = default;
};

/// What a pull does in the present pose.
struct PullForce {
  Vector point_mm;  ///< where it acts, world frame
  Vector force_N;
};

/// The force of a spring with a damper, at most F_max in size:
///     F = k (hand - p) - d v
/// p, v: place (mm) and velocity (mm/s) of the held point, k = 0.5 N/mm, d = 0.005 N s/mm (true seconds), F_max = 100 N.
/// Throws BadParameter if there is no such primitive.
PullForce pullForce(const World& world, const Pull& pull);

/// Adds the force of a pull to its body, for one step of the solver. Throws as pullForce.
void applyPull(const World& world, const Pull& pull);

}  // namespace musclesim
