/// Joints between two bodies, or between a body and the environment.
#pragma once

#include <ode/ode.h>

#include <string>
#include <utility>

#include "musclesim/robot/state.h"

namespace musclesim {

/// Where a joint's two bodies were when it was made, [0] seen from the first and [1] from the second (the environment: the world's frame).
struct JointReference {
  Vector anchor[2];          ///< balls and hinges: from the centre of mass, in the body's frame, mm
  Vector axis[2];            ///< sliders and hinges: unit vector in the body's frame
  Vector offset;             ///< sliders and fixed joints: first body seen from the second, in the second's frame, mm
  Eigen::Vector4d rotation;  ///< orientation (w, x, y, z) of the second body seen from the first
};

/// A joint with what is needed to report on it: a name, its angle and how far it is torn.
class Joint {
 public:
  enum class Kind { ball, hinge, hinge2, universal, slider, fixed };

  /// Takes a joint that is attached and has its anchor and axes set; the present pose is the reference for gapMm().
  Joint(Kind kind, dJointID id, std::string name);

  Kind kind() const { return kind_; }
  dJointID id() const { return id_; }
  const std::string& name() const { return name_; }
  void setName(const std::string& name) { name_ = name; }

  /// Angle about axis 0 or 1 in degrees, 0 in the pose as built, right-handed about the axis for a positive turn of the first body
  /// against the second. Throws BadParameter for joints without that axis.
  double angleDeg(int axis = 0) const;
  /// Least and greatest angle about axis 0 or 1 that stops of the joint allow, in degrees; infinite where it has none, and about the second
  /// axis of a two-axis hinge, whose stops are not the joint's own. Throws as angleDeg.
  std::pair<double, double> stopsDeg(int axis = 0) const;
  /// Distance in mm by which the joint is torn: between the anchor on one body and on the other; for sliders across the axis.
  double gapMm() const;
  /// Makes the present pose the reference, after a body's centre of mass has been moved.
  void takeReference();
  /// The pose of the two bodies against each other at construction; for joints of the kinds ball, hinge, slider and fixed.
  const JointReference& reference() const { return reference_pose_; }

 private:
  Vector separation() const;

  Kind kind_;
  dJointID id_;
  std::string name_;
  JointReference reference_pose_;
  Vector reference_;  ///< sliders and fixed joints: second body (or environment) seen from the first, in its frame, mm
};

}  // namespace musclesim
