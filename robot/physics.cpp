#include "musclesim/robot/physics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"

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

CompositeInertia compositeInertiaFromName(const std::string& name) {
  if (name == "exact") return CompositeInertia::exact;
  if (name == "summed") return CompositeInertia::summed;
  throw BadParameter("composite inertia", name, "be one of exact, summed");
}

std::string nameOf(CompositeInertia how) {
  return how == CompositeInertia::exact ? "exact" : "summed";
}

PhysicsSettings::PhysicsSettings(PhysicsKind physics_kind, Parameters& parameters) : kind(physics_kind) {
  const bool si = kind == PhysicsKind::si;
  const double deficit = kind == PhysicsKind::original ? original_force_deficit_ratio : 1.0;
  force_per_N = world_force_per_N / deficit;
  const double gravity = parameters.number("physics.gravity_m_per_s2", gravity_m_per_s2, "m/s^2", 0, 100, "acceleration of a falling body");
  gravity_mm_per_s2 = gravity * mm_per_m / deficit;
  error_reduction_ratio = parameters.number("physics.error_reduction_ratio", 0.2, "", 0, 1,
                                            "share of a joint error corrected per internal step where the rate is 0");
  error_reduction_rate_per_s = parameters.number("physics.error_reduction_rate_per_s", si ? 500 : 0, "1/s", 0, 1e4,
                                                 "rate at which joint errors are corrected; 0 = a fixed share per internal step");
  // CFM times a constraint force is a velocity. In `scaled` velocities are sqrt(1000) and forces 1000 times larger, so CFM is smaller.
  const double cfm = kind == PhysicsKind::scaled ? 1e-10 / std::sqrt(original_force_deficit_ratio) : 1e-10;
  constraint_force_mixing =
      parameters.number("physics.constraint_force_mixing", cfm, "s/g", 0, 1, "softness of all constraints (CFM of ODE)");
  contact_friction_N = parameters.number("physics.contact_friction_N", si ? 0 : 1e-4, "N", 0, 1e3,
                                         "limit of the tangential force of one contact, practically frictionless");
  has_contacts = parameters.choice("physics.contacts", "on", {"on", "off"}, "whether bodies touch or pass through each other") == "on";
  composite_inertia = compositeInertiaFromName(
      parameters.choice("physics.composite_inertia", si ? "exact" : "summed", {"exact", "summed"},
                        "inertia of composite bodies: parallel-axis theorem, or the original's sum of the parts' own"));
  longest_internal_step_s = std::numeric_limits<double>::infinity();
  contact_compliance = contact_time_constant_s = stability_margin_ratio = geometric_inertia_ratio = slider_stop_compliance =
      hinge_stop_compliance = stop_time_constant_s = 0;
  if (si) readOwnConstants(parameters);
}

void PhysicsSettings::readOwnConstants(Parameters& parameters) {
  longest_internal_step_s = parameters.number("physics.longest_internal_step_s", 2e-3, "s", 1e-7, 0.1, "upper bound of the internal step");
  contact_compliance =
      parameters.number("physics.contact_compliance_mm_per_N", 0.3, "mm/N", 0, 1e3, "compliance of a contact; 0 = soft as a joint") /
      force_per_N;
  contact_time_constant_s = parameters.number("physics.contact_time_constant_s", 0.002, "s", 1e-6, 10,
                                              "time in which bodies that overlap separate; damping of a contact over its stiffness");
  stability_margin_ratio = parameters.number("physics.stability_margin_ratio", 0.45, "", 0.01, 10,
                                             "automatic internal step as a share of the longest that is stable without additional inertia");
  geometric_inertia_ratio = parameters.number("physics.geometric_inertia_ratio", 0.25, "", 0, 10,
                                              "inertia that beads gain from tension F in a step h, as a share of h^2 F l / (2 links)");
  slider_stop_compliance =
      parameters.number("physics.slider_stop_compliance_mm_per_N", 1e-4, "mm/N", 0, 1, "compliance of the stops of a link's slider") /
      force_per_N;
  hinge_stop_compliance = parameters.number("physics.hinge_stop_compliance_rad_per_Nm", 0.03, "rad/(N m)", 0, 100,
                                            "compliance of the stops of the hinges between links") /
                          (force_per_N * mm_per_m);
  stop_time_constant_s = parameters.number("physics.stop_time_constant_s", 0.002, "s", 1e-6, 10,
                                           "time in which a link leaves a stop it has been pressed into; damping over stiffness");
}

double PhysicsSettings::errorReductionPerStep(double step_s) const {
  return error_reduction_rate_per_s > 0 ? std::min(0.8, error_reduction_rate_per_s * step_s) : error_reduction_ratio;
}

}  // namespace musclesim
