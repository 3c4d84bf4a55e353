/// Contacts between bodies: at most one per pair of bodies and step. Bodies connected by a joint and beads of the same muscle do not touch.
#pragma once

#include <ode/ode.h>

#include <vector>

#include "broad_phase.h"

namespace musclesim {

/// One contact of this step: two bodies (null: the environment) and a normal that points into the first body.
struct ContactPoint {
  dBodyID body[2];
  dContactGeom geometry;
};

class Contacts {
 public:
  /// `friction_limit` bounds the tangential force of a contact, in world units of force (ODE's surface mode 0).
  Contacts(dWorldID world, dSpaceID space, double friction_limit);
  ~Contacts();
  Contacts(const Contacts&) = delete;
  Contacts& operator=(const Contacts&) = delete;

  /// Finds all contacts in the present pose and makes contact joints for them. The contact joints of the previous step are removed.
  /// `revision`: Simulation::revision().
  void collide(long revision);
  /// Sets the error reduction (ERP) and softness (CFM) of contacts from now on. Until then contacts use the world's values.
  void soften(double error_reduction, double softness);
  /// Allocates memory for `count` contacts, so that steps do not allocate.
  void reserve(std::size_t count) { points_.reserve(count); }
  int count() const { return static_cast<int>(points_.size()); }
  const std::vector<ContactPoint>& points() const { return points_; }
  double frictionLimit() const { return friction_limit_; }

 private:
  static void onNear(void* contacts, dGeomID first, dGeomID second);
  void add(dGeomID first, dGeomID second);

  dWorldID world_;
  BroadPhase near_;
  double friction_limit_;
  dSurfaceParameters surface_ = {};
  dJointGroupID joints_;
  std::vector<ContactPoint> points_;
};

}  // namespace musclesim
