#include "musclesim/robot/muscle_settings.h"

namespace musclesim {

MuscleSettings::MuscleSettings(Parameters& p, MuscleModel model)
    : bead_radius_mm(p.number("muscle.bead_radius_mm", 7.5, "mm", 0.1, 100, "radius of a bead; a link holds two")),
      bead_mass_g(p.number("muscle.bead_mass_g", 10, "g", 1e-3, 1e5, "mass of one bead")),
      slider_friction_N(
          p.number("muscle.slider_friction_N", 1, "N", 0, 1e3, "dry friction of each link's slider; of a line muscle as a whole")),
      hinge_friction_Nm(p.number("muscle.hinge_friction_Nm", 0.008, "N m", 0, 10, "dry friction of each hinge between links")),
      hinge_limit_deg(p.number("muscle.hinge_limit_deg", 60, "deg", 0, 180, "stops of the hinges at full length")),
      hinge_bounce_ratio(p.number("muscle.hinge_bounce_ratio", 0.2, "", 0, 1, "restitution of the hinges' stops")),
      viscous(p.choice("muscle.joint_friction", "coulomb", {"coulomb", "viscous"},
                       "friction of sliders and hinges: constant, or growing with the speed") == "viscous"),
      slider_viscous_speed_mm_per_s(p.number("muscle.slider_viscous_speed_mm_per_s", 200, "mm/s", 0.1, 1e6,
                                             "speed at which viscous friction of a slider equals its dry friction")),
      hinge_viscous_speed_rad_per_s(p.number("muscle.hinge_viscous_speed_rad_per_s", 8, "rad/s", 0.01, 1e5,
                                             "speed at which viscous friction of a hinge equals its dry friction")),
      line(p.choice("muscle.model", "chain", {"chain", "line"}, "chains of beads, or massless straight lines") == "line") {
  if (model != MuscleModel::by_parameter) line = model == MuscleModel::line;
}

}  // namespace musclesim
