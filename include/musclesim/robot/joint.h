/// Joints between two bodies, or between a body and the environment.
#pragma once

#include <ode/ode.h>

#include <string>
#include <utility>

#include "musclesim/robot/state.h"

namespace musclesim {

/// Poses of a joint's two bodies when it was made: [0] as seen from the first body, [1] from the second (for the environment: in the world
/// frame).
struct JointReference {
  Vector anchor[2];          ///< from the centre of mass, in the body's frame, mm; sliders and fixed joints have none
  Vector axis[2];            ///< unit vector in the body's frame: the only axis, or [0] the first and [1] the second of two axes
  Vector offset;             ///< position of the first body relative to the second, in the second's frame, mm
  Eigen::Vector4d rotation;  ///< orientation (w, x, y, z) of the second body relative to the first
};

/// A joint of ODE with its name, its angle and its constraint error.
class Joint {
 public:
  enum class Kind { ball, hinge, hinge2, universal, slider, fixed };

  /// Wraps a joint that is already attached and has its anchor and axes. The present pose becomes the reference for constraintErrorMm().
  Joint(Kind kind, dJointID id, std::string name);

  Kind kind() const { return kind_; }
  dJointID id() const { return id_; }
  const std::string& name() const { return name_; }
  void setName(const std::string& name) { name_ = name; }

  /// Angle about axis 0 or 1 in degrees, 0 in the pose as built, positive if the first body turns right-handed about the axis relative to
  /// the second. It counts on beyond 180 degrees as long as countTurns() is called at least once per half turn; a simulation does so after
  /// every control step. Throws BadParameter for joints without that axis.
  double angleDeg(int axis = 0) const;
  /// Counts the turns of every axis that has an angle. `from_zero`: forgets turns made so far.
  void countTurns(bool from_zero = false);
  /// Least and greatest angle about axis 0 or 1 that the joint's stops allow, in degrees. They are infinite if there are no stops, and for
  /// the second axis of a two-axis hinge, whose stops belong to another joint. Throws like angleDeg.
  std::pair<double, double> stopsDeg(int axis = 0) const;
  /// Sets the stops of a slider: least and greatest position of the first body along the axis, 0 in the pose as built. Throws BadParameter
  /// for other joints, or unless the stops are finite, in order and contain 0.
  void setSliderStopsMm(double low_mm, double high_mm);
  /// Adds dry friction to a slider, or to the (first) axis of a hinge or universal joint: a motor at rest with a largest force, which adds
  /// up with earlier friction. `force` in the world's unit of force, for axes in that times mm; 0 changes nothing. Dry friction takes the
  /// motor from damping (dampByMotor).
  void addDryFriction(double force);
  double dryFriction() const { return dry_friction_; }
  /// Damps the same axis by a motor at rest of any force: speed = softness * force, softness > 0. Stable however strong it is. Where there
  /// is dry friction, someone else must damp (addJointMechanics).
  void dampByMotor(double softness);
  /// 0: it is not damped.
  double dampingSoftness() const { return damping_softness_; }
  /// Switches a damping motor off while the joint is at a stop, where ODE would press into the stop with all its force. Call it before
  /// every step.
  void freeAtStops() const;
  /// Constraint error in mm: the distance between the anchor on one body and the anchor on the other; for sliders the part perpendicular to
  /// the axis.
  double constraintErrorMm() const;
  /// Makes the present pose the reference. Call it after a body's centre of mass has moved.
  void takeReference();
  /// Relative pose of the two bodies at construction.
  const JointReference& reference() const { return reference_pose_; }

 private:
  Vector separation() const;
  int angleCount() const;
  double wrappedAngleDeg(int axis) const;
  double turnsAt(double wrapped_deg, int axis) const;
  void setParameter(int which, double value) const;
  double parameter(int which) const;

  Kind kind_;
  dJointID id_;
  std::string name_;
  JointReference reference_pose_;
  double counted_deg_[2] = {};  ///< angle when the turns were counted last
  double dry_friction_ = 0;
  double damping_softness_ = 0;
  Vector reference_;  ///< sliders and fixed joints: position of the second body (or environment) relative to the first, in the first's
                      ///< frame, mm
};

}  // namespace musclesim
