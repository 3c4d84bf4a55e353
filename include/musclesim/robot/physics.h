/// Physics settings: constants in true units, or those of the published program.
#pragma once

#include <string>

#include "musclesim/base/parameters.h"

namespace musclesim {

/// Set of constants that the world uses. All worlds are in mm, g, s.
enum class PhysicsKind {
  si,        ///< true seconds; the default, and required for any comparison with reality
  original,  ///< constants of the published program: gravity and forces are 1000 times too small, so motion is sqrt(1000) times too slow
  scaled     ///< constants of `original` in true units: the same motion, sqrt(1000) times faster
};

/// "si", "original" or "scaled". Throws BadParameter for any other name.
PhysicsKind physicsFromName(const std::string& name);
std::string nameOf(PhysicsKind kind);

/// How a composite body gets its moments of inertia.
enum class CompositeInertia {
  exact,  ///< by the parallel-axis theorem
  summed  ///< the original's plain sum of the parts' own
};
/// "exact" or "summed". Throws BadParameter for any other name.
CompositeInertia compositeInertiaFromName(const std::string& name);
std::string nameOf(CompositeInertia how);

/// Constants of the world, read from the parameters "physics.*"; their defaults depend on the kind.
struct PhysicsSettings {
  PhysicsSettings(PhysicsKind kind, Parameters& parameters);

  PhysicsKind kind;
  double force_per_N;                 ///< world units of force (g mm/s^2) that stand for 1 N
  double gravity_mm_per_s2;           ///< along -y, in world units
  double error_reduction_ratio;       ///< share of a joint's position error corrected per internal step; used if the rate is 0
  double error_reduction_rate_per_s;  ///< rate of that correction, so that the motion does not depend on the step; 0 = use the ratio
  double constraint_force_mixing;     ///< ODE's CFM
  double contact_friction_N;          ///< limit of the tangential force of a contact
  bool has_contacts;                  ///< false: bodies pass through each other
  double longest_internal_step_s;     ///< bound on the internal step; infinity = one internal step per control step
  double stability_margin_ratio;      ///< automatic internal step as a share of the longest stable one
  double geometric_inertia_ratio;     ///< a of the beads' additional inertia a h^2 F l / (2 n); 0 = none
  double contact_compliance;          ///< compliance of contacts, mm per world unit of force; 0 = soft as a joint
  double contact_time_constant_s;     ///< damping of contacts over their stiffness
  double slider_stop_compliance;      ///< compliance of the links' slider stops, mm per world unit of force; 0 = ODE's own softness
  double hinge_stop_compliance;       ///< compliance of the stops of the hinges between links, rad per world unit of torque
  double stop_time_constant_s;        ///< damping of these stops over their stiffness
  CompositeInertia composite_inertia;

  /// ODE's error reduction (ERP) for a step of length `step_s`: the ratio, or min(0.8, rate * step).
  double errorReductionPerStep(double step_s) const;
  /// ODE's parameters for a stop with stiffness 1/compliance and damping (time constant)/compliance, in a step h:
  ///     ERP = h / (h + time constant),   CFM = compliance / (h + time constant)
  /// The stop's force is then the force of the spring and the damper at the end of the step, for any h.
  struct Stop {
    double error_reduction, softness;
  };
  static Stop stop(double compliance, double time_constant_s, double step_s) {
    return {step_s / (step_s + time_constant_s), compliance / (step_s + time_constant_s)};
  }

 private:
  void readOwnConstants(Parameters& parameters);
};

}  // namespace musclesim
