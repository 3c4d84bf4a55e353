/// A mechanism as a model of MuJoCo (MJCF).
#pragma once

#include <string>

#include "mechanism.h"

namespace musclesim::peers {

struct MjcfOptions {
  double step_s = 1e-3;
  std::string integrator = "Euler";  ///< Euler, RK4, implicit
  std::string solver = "Newton";     ///< Newton, CG, PGS
  bool hard_stops = false;           ///< stops give way less under loads that are heavy against the bodies at the joint
};

/// Bodies are "b<index>", joints "j<index>" (the second axis of a universal joint "j<index>_2"), tendons and motors of line muscles
/// "m<index>". No shapes: nothing touches.
///
/// MuJoCo's constraints are springs and dampers: a = -2 v/T - x/(T z)^2, T the time constant, z the damping ratio. All get the shortest
/// time constant that its own rule allows, two steps. Stops are damped so much (z^2 = tau / 2T) that a joint leaves them within tau = 2 ms,
/// as in musclesim. The impedance stays MuJoCo's (0.9 to 0.95), or is 0.999 to 0.9999 for
/// hard stops.
std::string mjcfOf(const Mechanism& mechanism, const Tree& tree, const MjcfOptions& options);

}  // namespace musclesim::peers
