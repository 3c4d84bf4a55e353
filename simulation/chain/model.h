/// The chain stepper's model of a robot: bones, chains of beads, and the joints between bones.
#pragma once

#include <string>
#include <vector>

#include "body_state.h"
#include "joint_rows.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/primitive.h"

namespace musclesim {
class World;
}

namespace musclesim::chain {

/// A body of the skeleton: mass in g, inertia in its own axes in g mm^2.
struct Bone {
  double mass_g = 0;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();
  bool gravity = true, gyroscopic = true;
  bool operator==(const Bone&) const = default;
};

/// One actuator: L links, 2L beads, joints slider, hinge, slider, ..., slider, ball at the end.
struct Chain {
  const Actuator* actuator = nullptr;
  int first_bead = 0;  ///< index of the body at the chain's start; the other beads follow
  double bead_mass_g = 0;
  double sphere_inertia = 0;       ///< inertia of a bead about any axis, g mm^2
  double bead_inertia = 0;         ///< the same plus the additional inertia of the present step
  std::vector<JointModel> joints;  ///< 2L: joint k joins bead k and bead k + 1; the last is the ball at the end
  JointModel start;                ///< ball at the start, on bead 0

  int beadCount() const { return static_cast<int>(joints.size()); }
};

/// Bodies 0 .. bones - 1 are bones; the beads follow, chain after chain.
struct Model {
  BodyState bodies;
  std::vector<Bone> bones;
  std::vector<Chain> chains;
  std::vector<JointModel> skeleton;  ///< joints between two bones or between a bone and the environment
  std::vector<JointModel> fixed;     ///< bones fixed to the environment

  int boneCount() const { return static_cast<int>(bones.size()); }
  /// A bead's chain and its place in that chain; chain -1 for bones and the environment.
  struct BeadPlace {
    int chain, bead;
  };
  BeadPlace placeOf(int body) const { return body < 0 ? BeadPlace{-1, 0} : places[static_cast<std::size_t>(body)]; }
  std::vector<BeadPlace> places;
  /// Reads the bones' mass and inertia, which may have changed since the last step.
  void readBones();
};

/// Registers everything built in a world. Returns the reason why the chain stepper cannot handle it, or "" if it can.
std::string registerModel(const World& world, Model& model);

}  // namespace musclesim::chain
