/// Another engine that moves the same robot.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mechanism.h"

namespace musclesim::peers {

/// A robot in another engine, at rest in the pose in which its mechanism was read.
class Peer {
 public:
  virtual ~Peer() = default;
  /// Moves the robot by a number of the engine's steps under these pressures (fractions of full scale).
  virtual void advance(const Action& pressure_ratio, int step_count) = 0;
  /// The hand in the world.
  virtual Vector handM() const = 0;
  /// The largest distance of the two anchors of a joint.
  virtual double gapM() const = 0;
  /// Coordinate of a joint's first axis, 0 in the pose in which the mechanism was read.
  virtual double coordinate(int joint) const = 0;
  /// Kinetic energy, and potential energy of gravity against y = 0.
  virtual double energyJ() const = 0;
};

struct PeerSettings {
  std::string method;  ///< one of the engine's methods
  double step_s;
};

struct PeerEngine {
  const char* name;
  std::string version;
  std::vector<std::string> methods;  ///< integrators and solvers, the most usual first
  /// The mechanism and the muscles that it refers to must outlive the peer.
  std::unique_ptr<Peer> (*make)(const Mechanism& mechanism, const Tree& tree, const PeerSettings& settings);
};

}  // namespace musclesim::peers
