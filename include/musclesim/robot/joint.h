/// Joints between two bodies, or between a body and the environment.
#pragma once

#include <ode/ode.h>

#include <string>

#include "musclesim/robot/state.h"

namespace musclesim {

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
  /// Distance in mm by which the joint is torn: between the anchor on one body and on the other; for sliders across the axis.
  double gapMm() const;

 private:
  Vector separation() const;

  Kind kind_;
  dJointID id_;
  std::string name_;
  Vector reference_;  ///< sliders and fixed joints: second body (or environment) seen from the first, in its frame, mm
};

}  // namespace musclesim
