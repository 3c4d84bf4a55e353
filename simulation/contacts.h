/// Contacts between bodies: at most one per pair of bodies and step, none between bodies that a joint connects, none within one muscle.
#pragma once

#include <ode/ode.h>

#include <vector>

#include "near_pairs.h"

namespace musclesim {

/// One contact of this step: bodies (null: the environment), and a normal that points into the first.
struct ContactPoint {
  dBodyID body[2];
  dContactGeom geometry;
};

class Contacts {
 public:
  /// `friction_limit` in world units of force: with ODE's surface mode 0 the tangential force is bounded by this number.
  Contacts(dWorldID world, dSpaceID space, double friction_limit);
  ~Contacts();
  Contacts(const Contacts&) = delete;
  Contacts& operator=(const Contacts&) = delete;

  /// Finds all contacts in the present pose and makes their joints; those of the step before are removed.
  /// `revision`: Simulation::revision().
  void collide(long revision);
  /// Error reduction and softness of contacts from now on, in ODE's terms; without them they are the world's.
  void soften(double error_reduction, double softness);
  /// Memory for that many contacts, so that steps need not ask for it.
  void reserve(std::size_t count) { points_.reserve(count); }
  int count() const { return static_cast<int>(points_.size()); }
  const std::vector<ContactPoint>& points() const { return points_; }
  double frictionLimit() const { return friction_limit_; }

 private:
  static void onNear(void* contacts, dGeomID first, dGeomID second);
  void add(dGeomID first, dGeomID second);

  dWorldID world_;
  NearPairs near_;
  double friction_limit_;
  dSurfaceParameters surface_ = {};
  dJointGroupID joints_;
  std::vector<ContactPoint> points_;
};

}  // namespace musclesim
