/// The two physics settings: true units, and the published program's own.
#pragma once

#include <string>

#include "musclesim/base/parameters.h"

namespace musclesim {

/// Which constants the world runs on. All worlds are in mm, g, s.
enum class PhysicsKind {
  si,        ///< true seconds; the default, and what any comparison with reality needs
  original,  ///< the published program's constants: gravity and forces 1000 times too small, so everything runs sqrt(1000) times too slowly
  scaled     ///< the original's constants in true units: the original's motion, sqrt(1000) times faster
};

/// "si", "original" or "scaled". Throws BadParameter for any other name.
PhysicsKind physicsFromName(const std::string& name);
std::string nameOf(PhysicsKind kind);

/// Constants of the world, read from the parameters "physics.*"; their defaults depend on the kind.
struct PhysicsSettings {
  PhysicsSettings(PhysicsKind kind, Parameters& parameters);

  PhysicsKind kind;
  double force_per_N;                 ///< world units of force (g mm/s^2) that stand for 1 N
  double gravity_mm_per_s2;           ///< along -y, in world units
  double error_reduction_ratio;       ///< share of a joint's position error corrected per internal step, used where the rate is 0
  double error_reduction_rate_per_s;  ///< the same as a rate, so that the motion does not depend on the step; 0 = use the ratio
  double constraint_force_mixing;     ///< ODE's CFM
  double contact_friction_N;          ///< limit of the tangential force of a contact
  bool has_contacts;                  ///< whether bodies touch or pass through each other
  double longest_internal_step_s;     ///< bound on the internal step; infinity = one internal step per control step
  double stability_margin_ratio;      ///< automatic internal step as a share of the longest stable one
  double geometric_inertia_ratio;     ///< a of the beads' additional inertia a h^2 F l / (2 n); 0 = none
  double contact_compliance;          ///< of contacts, mm per world unit of force; 0 = as joint errors
  double contact_time_constant_s;     ///< their damping over their stiffness
  double slider_stop_compliance;      ///< of the stops of the links' sliders, mm per world unit of force; 0 = ODE's own softness
  double hinge_stop_compliance;       ///< of the stops of the hinges between links, rad per world unit of torque
  double stop_time_constant_s;        ///< damping of both over their stiffness
  std::string composite_inertia;      ///< "exact" or "summed" (the original's plain sum of the parts' inertias)

  /// Error reduction per step of length `step_s`, for ODE: the ratio, or min(0.8, rate * step).
  double errorReductionPerStep(double step_s) const;
  /// A stop with the stiffness 1/compliance and the damping time constant/compliance in ODE's terms, for a step h:
  ///     ERP = h / (h + time constant),   CFM = compliance / (h + time constant)
  /// so that the force is that of the spring and the damper at the end of the step, whatever the step.
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
