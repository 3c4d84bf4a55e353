#include "actuator_step.h"

#include <algorithm>
#include <cmath>

#include "musclesim/base/units.h"
#include "musclesim/robot/line_of_pull.h"

namespace musclesim {

namespace {

double beadInertia(const MuscleSettings& settings) {
  return 0.4 * settings.bead_mass_g * settings.bead_radius_mm * settings.bead_radius_mm;
}

/// Where a joint is at a stop before the step, ODE lets the motor press into the stop; viscous friction then rests.
void setViscousMotors(const Actuator& actuator) {
  for (const Link& link : actuator.links()) {
    const dJointID id = link.slider->id();
    const double position = dJointGetSliderPosition(id);
    const bool at_stop = position <= dJointGetSliderParam(id, dParamLoStop) || position >= dJointGetSliderParam(id, dParamHiStop);
    dJointSetSliderParam(id, dParamFMax, at_stop || actuator.settings().slider_friction_N == 0 ? 0 : dInfinity);
  }
  const double stop_rad = hingeStopRad(actuator);
  for (const Joint* hinge : actuator.hinges()) {
    const bool at_stop = stop_rad >= 0 && std::abs(dJointGetHingeAngle(hinge->id())) >= stop_rad;
    dJointSetHingeParam(hinge->id(), dParamFMax, at_stop || actuator.settings().hinge_friction_Nm == 0 ? 0 : dInfinity);
  }
}

}  // namespace

double hingeStopRad(const Actuator& actuator) {
  return actuator.settings().hinge_limit_deg * rad_per_deg * actuator.lengthRatio();
}

double beadInertiaIncrease(const Actuator& actuator, double h_s) {
  const PhysicsSettings& physics = actuator.world().physics();
  if (physics.geometric_inertia_ratio == 0 || actuator.links().empty()) return 0;
  const double force = std::max(0.0, actuator.tensionN()) * physics.force_per_N;
  return physics.geometric_inertia_ratio * h_s * h_s * force * actuator.lengthMm() / (2 * static_cast<double>(actuator.links().size()));
}

void applyBeadInertia(const Actuator& actuator, double h_s) {
  if (actuator.world().physics().geometric_inertia_ratio == 0) return;
  dMass mass;
  dMassSetSphereTotal(&mass, actuator.settings().bead_mass_g, actuator.settings().bead_radius_mm);
  const double increase = beadInertiaIncrease(actuator, h_s);
  for (const int diagonal : {0, 5, 10}) mass.I[diagonal] += increase;
  for (const Link& link : actuator.links())
    for (const dBodyID bead : link.bead) dBodySetMass(bead, &mass);
}

double fastestSwayRadPerS(const Actuator& actuator) {
  constexpr int sample_count = 64;
  if (actuator.links().empty()) return 0;
  const MuscleSettings& settings = actuator.settings();
  const auto count = static_cast<double>(actuator.links().size());
  const auto [shortest_mm, longest_mm] = actuator.straightLengthRange();
  double largest = 0;
  for (int i = 0; i <= sample_count; ++i) {
    const double length_mm = shortest_mm + (longest_mm - shortest_mm) * i / sample_count;
    const double link_mm = length_mm / count, d = link_mm - 2 * settings.bead_radius_mm;
    const double inertia = settings.bead_mass_g * d * d / 2 + 2 * beadInertia(settings);
    for (const double pressure : {0.0, 0.5, 1.0})
      largest =
          std::max(largest, actuator.calculateForce(pressure, length_mm) * actuator.world().physics().force_per_N * link_mm / inertia);
  }
  return std::sqrt(largest);
}

void applyForces(const Actuator& actuator) {
  const PhysicsSettings& physics = actuator.world().physics();
  if (actuator.line())
    return actuator.line()->pull(std::max(0.0, actuator.tensionN()), actuator.maximumLengthMm(), actuator.settings(), physics);
  if (actuator.settings().viscous) setViscousMotors(actuator);
  const double force = actuator.tensionN() * physics.force_per_N;
  for (const Link& link : actuator.links()) dJointAddSliderForce(link.slider->id(), force);
  const double stop_rad = hingeStopRad(actuator);
  for (const Joint* hinge : actuator.hinges()) {
    dJointSetHingeParam(hinge->id(), dParamLoStop, -stop_rad);
    dJointSetHingeParam(hinge->id(), dParamHiStop, stop_rad);
  }
}

}  // namespace musclesim
