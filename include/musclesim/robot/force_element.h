/// Springs, dampers and the like: whatever pushes bodies besides muscles, gravity and joints.
#pragma once

#include <ode/ode.h>

#include <functional>

#include "musclesim/robot/robot_effects.h"

namespace musclesim {

/// Belongs to the world in which it acts (World::addForceElement). The simulation asks it for its loads before every internal step.
class ForceElement {
 public:
  virtual ~ForceElement() = default;

  using AddLoad = std::function<void(dBodyID body, const BodyLoad& load)>;
  /// Calls `add` for every body on which it acts, with force in N and torque about the centre of mass in N mm, world frame. `at_rest`: the
  /// loads that it would have in the present pose without motion.
  virtual void load(bool at_rest, const AddLoad& add) const = 0;
  /// Whether it does nothing but damp a joint as Joint::dampingSoftness says.
  virtual bool onlyDampsAJoint() const { return false; }
  /// Keeps points on a body where they are although its centre of mass has moved by `shift_mm`, in the body's frame.
  virtual void moveCenter(dBodyID body, const Vector& shift_mm) {
    static_cast<void>(body);
    static_cast<void>(shift_mm);
  }
};

}  // namespace musclesim
