/// Contacts between bodies: at most one per pair of bodies and step, none between bodies that a joint connects, none within one muscle.
#pragma once

#include <ode/ode.h>

namespace musclesim {

class Contacts {
 public:
  /// `friction_limit` in world units of force: with ODE's surface mode 0 the tangential force is bounded by this number.
  Contacts(dWorldID world, dSpaceID space, double friction_limit);
  ~Contacts();
  Contacts(const Contacts&) = delete;
  Contacts& operator=(const Contacts&) = delete;

  /// Finds all contacts in the present pose and makes their joints; those of the step before are removed.
  void collide();
  int count() const { return count_; }

 private:
  static void onNear(void* contacts, dGeomID first, dGeomID second);
  void add(dGeomID first, dGeomID second);

  dWorldID world_;
  dSpaceID space_;
  double friction_limit_;
  dJointGroupID joints_;
  int count_ = 0;
};

}  // namespace musclesim
