/// What an internal step takes from an actuator: its tension as forces on the bodies, and the stops and inertias that depend on it.
#pragma once

#include "musclesim/robot/actuator.h"

namespace musclesim {

/// Hands the tension to the sliders and sets the hinges' stops, for ODE's steppers; a line pulls at its ends.
void applyForces(const Actuator& actuator);
/// Geometric stiffness as inertia: what every bead's moment of inertia gains in a step h under the present tension F, in g mm^2,
///     a h^2 F l / (2 n),   n links of length l / n.
/// With a = 1/4 the swaying of neighbouring links, driven by F, never gets faster than a step can follow.
double beadInertiaIncrease(const Actuator& actuator, double h_s);
/// Gives it to ODE's bodies.
void applyBeadInertia(const Actuator& actuator, double h_s);
/// Largest rate in rad/s at which neighbouring links can sway against each other, over all pressures and lengths:
///     w^2 = F (d + 2 r) / (m d^2 / 2 + 2 I),   d distance of a link's beads, r, m, I radius, mass and moment of inertia of a bead.
double fastestSwayRadPerS(const Actuator& actuator);
/// The hinges' stops at present, at minus and plus this angle.
double hingeStopRad(const Actuator& actuator);

}  // namespace musclesim
