/// Numbers that all muscles of a world share.
#pragma once

#include "musclesim/base/parameters.h"

namespace musclesim {

/// How a muscle is modelled: a chain of beads or a massless line, or as the parameter muscle.model says.
enum class MuscleModel { by_parameter, chain, line };

/// Numbers of all muscles, read from the parameters "muscle.*".
struct MuscleSettings {
  explicit MuscleSettings(Parameters& parameters, MuscleModel model = MuscleModel::by_parameter);
  double bead_radius_mm;  ///< a link is never shorter than two radii
  double bead_mass_g;
  double slider_friction_N;  ///< dry friction of each slider
  double hinge_friction_Nm;  ///< dry friction of each hinge
  double hinge_limit_deg;    ///< stops of each hinge at full length; they close in proportion to the length ratio
  double hinge_bounce_ratio;
  bool viscous;                          ///< joint friction grows with the speed instead of being constant (dry)
  double slider_viscous_speed_mm_per_s;  ///< viscous friction equals the dry one's force at this speed
  double hinge_viscous_speed_rad_per_s;
  bool line;  ///< massless straight muscles instead of chains of beads
};

}  // namespace musclesim
