#include "muscle_forces.h"

#include <algorithm>

#include "musclesim/base/units.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/line_of_pull.h"

namespace musclesim::peers {

double tensionN(const Actuator& actuator, double pressure_ratio, double length_m) {
  return std::max(0.0, actuator.calculateForce(pressure_ratio, length_m * mm_per_m));
}

double lineForceN(const Actuator& actuator, double pressure_ratio, double length_m, double speed_m_per_s) {
  return tensionN(actuator, pressure_ratio, length_m) + LineOfPull::frictionN(speed_m_per_s * mm_per_m, actuator.settings()) +
         LineOfPull::stopN(length_m * mm_per_m, actuator.maximumLengthMm());
}

double hingeStopRad(const Actuator& actuator, double length_m) {
  const double least_mm = actuator.minimumLengthMm(), most_mm = actuator.maximumLengthMm();
  return actuator.settings().hinge_limit_deg * rad_per_deg * std::max(0.0, (length_m * mm_per_m - least_mm) / (most_mm - least_mm));
}

}  // namespace musclesim::peers
