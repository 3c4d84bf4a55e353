#include "musclesim/simulation/physics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "musclesim/error.h"
#include "musclesim/units.h"

namespace musclesim {

PhysicsKind physicsFromName(const std::string& name) {
  if (name == "si") return PhysicsKind::si;
  if (name == "original") return PhysicsKind::original;
  if (name == "scaled") return PhysicsKind::scaled;
  throw BadParameter("physics", name, "be one of si, original, scaled");
}

std::string nameOf(PhysicsKind kind) {
  return kind == PhysicsKind::si ? "si" : kind == PhysicsKind::original ? "original" : "scaled";
}

PhysicsSettings::PhysicsSettings(PhysicsKind physics_kind, Parameters& parameters) : kind(physics_kind) {
  const bool si = kind == PhysicsKind::si;
  const double deficit = kind == PhysicsKind::original ? original_force_deficit_ratio : 1.0;
  force_per_N = world_force_per_N / deficit;
  const double gravity = parameters.number("physics.gravity_m_per_s2", gravity_m_per_s2, "m/s^2", 0, 100, "acceleration of a falling body");
  gravity_mm_per_s2 = gravity * mm_per_m / deficit;
  error_reduction_ratio = parameters.number("physics.error_reduction_ratio", 0.2, "", 0, 1,
                                            "share of a joint error corrected per internal step where the rate is 0");
  error_reduction_rate_per_s = parameters.number("physics.error_reduction_rate_per_s", si ? 100 : 0, "1/s", 0, 1e4,
                                                 "rate at which joint errors are corrected; 0 = a fixed share per internal step");
  // A constraint force times CFM is a velocity, so in `scaled` units, sqrt(1000) times faster and forces 1000 times larger, CFM is smaller.
  const double cfm = kind == PhysicsKind::scaled ? 1e-10 / std::sqrt(original_force_deficit_ratio) : 1e-10;
  constraint_force_mixing =
      parameters.number("physics.constraint_force_mixing", cfm, "s/g", 0, 1, "softness of all constraints (CFM of ODE)");
  contact_friction_N = parameters.number("physics.contact_friction_N", 1e-4, "N", 0, 1e3,
                                         "limit of the tangential force of one contact, practically frictionless");
  composite_inertia = parameters.choice("physics.composite_inertia", si ? "exact" : "summed", {"exact", "summed"},
                                        "inertia of composite bodies: parallel-axis theorem, or the original's sum of the parts' own");
  longest_internal_step_s = std::numeric_limits<double>::infinity();
  if (si)
    longest_internal_step_s =
        parameters.number("physics.longest_internal_step_s", 3e-4, "s", 1e-7, 0.1, "upper bound of the internal step");
}

double PhysicsSettings::errorReductionPerStep(double step_s) const {
  return error_reduction_rate_per_s > 0 ? std::min(0.8, error_reduction_rate_per_s * step_s) : error_reduction_ratio;
}

}  // namespace musclesim
