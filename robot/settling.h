/// Static equilibrium of any robot whose joints form a tree.
#pragma once

#include "musclesim/robot/world.h"

namespace musclesim {

/// Places all bodies and muscles of a world, at rest, at the frictionless equilibrium that they reach from the pose as built under the
/// pressures in the muscles: Q(q) = 0, or Q presses a coordinate into its stop (RestingForces, Skeleton). It does not depend on where the
/// bodies are at present.
///
/// One coordinate: the first root of Q on the way that Q pushes it, to the last bit (restFrom).
/// Several: Newton's method for a minimum of the potential energy,
///     (K + mu) d = Q,   K = -dQ/dq by central differences, its symmetric part, of the coordinates that do not rest at a stop,
///     mu >= 0 large enough to make K + mu positive definite (Levenberg),
/// with angles multiplied by a lever of 100 mm. Every step goes downhill: it is shortened until the forces at its end do not push back
/// along it with more than half of what they push forward at its start, and it ends at the first stop on its way. It has arrived when the
/// energy that is still to be gained, Q . d (Newton's decrement), is 1e-22 of the typical force times the lever; at that relative accuracy,
/// 1e-11, rounding begins.  Source: Nocedal & Wright, Numerical Optimization, Ch. 3 and 16.
///
/// A pose as built that is in balance stays, also where the balance is unstable. Contacts between bodies do not count.
///
/// Throws BadParameter as Skeleton and RestingForces do and where it finds no equilibrium; the message names the joint that is out of
/// balance most, and by how much. The bodies are then where they were, at rest.
void placeAtRest(World& world);

}  // namespace musclesim
