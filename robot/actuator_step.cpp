/// What an actuator does in an internal step: it hands its tension to the bodies.
#include <algorithm>
#include <cmath>

#include "musclesim/base/units.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/line_of_pull.h"

namespace musclesim {

double Actuator::hingeStopRad() const {
  return settings_.hinge_limit_deg * rad_per_deg * lengthRatio();
}

double Actuator::beadInertia() const {
  return 0.4 * settings_.bead_mass_g * settings_.bead_radius_mm * settings_.bead_radius_mm;
}

double Actuator::beadInertiaIncrease(double h_s) const {
  if (world_.physics().geometric_inertia_ratio == 0 || links_.empty()) return 0;
  const double force = std::max(0.0, tensionN()) * world_.physics().force_per_N;
  return world_.physics().geometric_inertia_ratio * h_s * h_s * force * lengthMm() / (2 * static_cast<double>(links_.size()));
}

void Actuator::applyBeadInertia(double h_s) {
  if (world_.physics().geometric_inertia_ratio == 0) return;
  dMass mass;
  dMassSetSphereTotal(&mass, settings_.bead_mass_g, settings_.bead_radius_mm);
  const double increase = beadInertiaIncrease(h_s);
  for (const int diagonal : {0, 5, 10}) mass.I[diagonal] += increase;
  for (const Link& link : links_)
    for (const dBodyID bead : link.bead) dBodySetMass(bead, &mass);
}

double Actuator::fastestSwayRadPerS() const {
  constexpr int sample_count = 64;
  if (links_.empty()) return 0;
  const auto count = static_cast<double>(links_.size());
  const auto [shortest_mm, longest_mm] = straightLengthRange();
  double largest = 0;
  for (int i = 0; i <= sample_count; ++i) {
    const double length_mm = shortest_mm + (longest_mm - shortest_mm) * i / sample_count;
    const double link_mm = length_mm / count, d = link_mm - 2 * settings_.bead_radius_mm;
    const double inertia = settings_.bead_mass_g * d * d / 2 + 2 * beadInertia();
    for (const double pressure : {0.0, 0.5, 1.0})
      largest = std::max(largest, calculateForce(pressure, length_mm) * world_.physics().force_per_N * link_mm / inertia);
  }
  return std::sqrt(largest);
}

/// Where a joint is at a stop before the step, ODE lets the motor press into the stop; viscous friction then rests.
void Actuator::setViscousMotors() {
  for (const Link& link : links_) {
    const dJointID id = link.slider->id();
    const double position = dJointGetSliderPosition(id);
    const bool at_stop = position <= dJointGetSliderParam(id, dParamLoStop) || position >= dJointGetSliderParam(id, dParamHiStop);
    dJointSetSliderParam(id, dParamFMax, at_stop || settings_.slider_friction_N == 0 ? 0 : dInfinity);
  }
  const double stop_rad = hingeStopRad();
  for (const Joint* hinge : hinges_) {
    const bool at_stop = stop_rad >= 0 && std::abs(dJointGetHingeAngle(hinge->id())) >= stop_rad;
    dJointSetHingeParam(hinge->id(), dParamFMax, at_stop || settings_.hinge_friction_Nm == 0 ? 0 : dInfinity);
  }
}

void Actuator::applyForces() {
  if (line_) return line_->pull(std::max(0.0, tensionN()), maximum_length_mm_, settings_, world_.physics());
  if (settings_.viscous) setViscousMotors();
  const double force = tensionN() * world_.physics().force_per_N;
  for (const Link& link : links_) dJointAddSliderForce(link.slider->id(), force);
  const double stop_rad = hingeStopRad();
  for (const Joint* hinge : hinges_) {
    dJointSetHingeParam(hinge->id(), dParamLoStop, -stop_rad);
    dJointSetHingeParam(hinge->id(), dParamHiStop, stop_rad);
  }
}

}  // namespace musclesim
