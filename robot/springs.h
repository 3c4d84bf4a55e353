/// Passive mechanics of robots: friction, damping and springs of joints, springs between bodies, walls.
#pragma once

#include "musclesim/robot/force_element.h"
#include "musclesim/robot/primitive.h"
#include "musclesim/robot/world.h"

namespace musclesim {

/// Of a hinge (N m, N m s/rad, N m/rad, degrees) or a slider (N, N s/m, N/mm, mm); zeros: none.
struct JointMechanics {
  double friction = 0, damping = 0, stiffness = 0, rest = 0;
};

/// Gives a hinge, a universal joint (its first axis) or a slider
///     tau = -F sign(dq/dt) - d dq/dt - k (q - q_0),   at rest -F .. F in place of the first term
/// q coordinate, F dry friction, d damping, k stiffness, q_0 rest. Dry friction is a bounded constraint force of the solver, so a joint
/// that rests does not creep; damping without friction is one, too, and so cannot make a step unstable. Damping beside friction (also
/// friction that an effect adds) and the spring act with the speed and the position at the start of the internal step. Throws BadParameter
/// for values that are negative or not finite.
void addJointMechanics(World& world, Joint& joint, const JointMechanics& mechanics);

struct PointSpringSettings {
  double stiffness_N_per_mm = 0, rest_mm = 0, damping_Ns_per_m = 0;
  bool pulls_only = false;  ///< a rope: no force while shorter than rest_mm
};

/// A massless spring between two points:  F = k (l - l_0) + d dl/dt, pulling the points together.
class PointSpring final : public ForceElement {
 public:
  /// Points of the world in the pose as built. Throws BadParameter for values that are negative or not finite.
  PointSpring(World& world, const Attachment& from, const Attachment& to, const PointSpringSettings& settings);
  void load(bool at_rest, const AddLoad& add) const override;
  void moveCenter(dBodyID body, const Vector& shift_mm) override;
  /// The ends in the present pose, points of the world.
  std::pair<Vector, Vector> endsMm() const;
  /// Distance of the ends in the present pose.
  double lengthMm() const;
  const PointSpringSettings& settings() const { return settings_; }

 private:
  double speed_ratio_;  ///< true speed over speed in world units
  Attachment ends_[2];  ///< points in the frames of the bodies, or in the world
  PointSpringSettings settings_;
};

/// A plane that pushes a point of a body back out:  F = k depth along the normal.
class Wall final : public ForceElement {
 public:
  /// `point`: a point of a body, given in the world in the pose as built. Throws BadParameter for a normal without direction or a stiffness
  /// that is not positive.
  Wall(World& world, const Attachment& point, const Vector& at_mm, const Vector& normal, double stiffness_N_per_mm);
  void load(bool at_rest, const AddLoad& add) const override;
  void moveCenter(dBodyID body, const Vector& shift_mm) override;

 private:
  Attachment point_;  ///< in the body's frame
  Vector at_mm_, normal_;
  double stiffness_N_per_mm_;
};

}  // namespace musclesim
