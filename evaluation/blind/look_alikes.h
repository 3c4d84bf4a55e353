/// The answers that count as right besides the true effect: look-alikes that the measured signals cannot distinguish from it. Frozen when a
/// case is made.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace musclesim {
class Robot;
}

namespace musclesim::blind {

/// The kinds of signals that a recording measures.
struct Measured {
  bool pressure = false, force = false;
  int signal_count = 0;
};
Measured measuredBy(const std::vector<std::string>& signals);

/// Patterns "id@component", component "*" for any. The truth comes first. An effect that acts on one place only may be named with any
/// component. Look-alikes (docs/reference/effects.md):
///   neither pressure nor force measured   valve_lag, viscous_loss, joint_viscous_friction; transport_delay, sensor_delay of all signals
///   pressure not measured                 force_gain, pressure_calibration; leak, creep
///   one joint or none                     external_force for base_tilt: to first order, a tilt is a sideways force in proportion to the
///   mass always                                contact of a joint for joint_stop_offset: a stop within reach is a wall
/// Look-alikes that depend on the motion (small range, static data) do not count as right.
std::vector<std::string> acceptableAnswers(const std::string& id, const std::string& component, const std::vector<std::string>& signals,
                                           const Robot& robot);

/// Whether "id@component" fits a pattern. A muscle pair fits in either order; hand, base and all name the same place.
bool fits(const std::string& answer, const std::string& pattern);
bool fitsAny(const std::string& answer, const std::vector<std::string>& patterns);

/// Whether two effects are a pair that some recordings cannot distinguish (docs/reference/effects.md), whatever is measured.
bool areOfOneClass(const std::string& one_id, const std::string& other_id);

/// "valve_lag" of "valve_lag@muscle_0".
std::string idOf(const std::string& label);

}  // namespace musclesim::blind
