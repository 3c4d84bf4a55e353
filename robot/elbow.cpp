#include "musclesim/robot/elbow.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/muscle.h"

namespace musclesim {

Elbow::Elbow(World& world) : Robot(world) {
  const double forearm_kg = parameter("elbow.forearm_kg", 0.6, "kg", 1e-4, 1e3, "mass of the forearm");
  const double inertia_kgm2 =
      parameter("elbow.forearm_inertia_kgm2", 0.0125, "kg m^2", 1e-7, 1e3, "moment of inertia of the forearm about the hinge");
  const double center_of_mass_mm =
      parameter("elbow.center_of_mass_mm", 120, "mm", 0, 1e4, "distance of the forearm's centre of mass from the hinge");
  const double minimum_mm = parameter("elbow.minimum_length_mm", 150, "mm", 15, 1e4, "both muscles: shortest length");
  const double maximum_mm = parameter("elbow.maximum_length_mm", 320, "mm", 15, 1e4, "both muscles: longest length");
  const double stop_deg = parameter("elbow.stop_deg", 70, "deg", 0, 170, "joint stops at minus and plus this angle");
  const double hand_mm = parameter("elbow.hand_mm", 250, "mm", 0, 1e4, "distance of the hand from the hinge");
  const double lever_mm = parameter("elbow.lever_mm", 35, "mm", 0, 1e3, "distance of the attachments from the middle plane");
  const double lower_mm =
      parameter("elbow.lower_attachment_mm", -20, "mm", -1e3, 1e3, "height of the attachments on the forearm at angle 0");
  const double upper_mm = parameter("elbow.upper_attachment_mm", 240, "mm", 1, 1e4, "height of the attachments in the world");

  constexpr double drawn_radius_mm = 12;
  const double own_inertia_kgm2 = inertia_kgm2 - forearm_kg * std::pow(center_of_mass_mm / mm_per_m, 2);
  if (!(own_inertia_kgm2 > 0))
    throw BadParameter("elbow.forearm_inertia_kgm2", std::to_string(inertia_kgm2) + " kg m^2",
                       "be larger than forearm_kg * center_of_mass_mm^2, the inertia of a point mass there");
  auto* forearm = new CappedCylinder(world, nullptr, {0, -center_of_mass_mm, 0}, forearm_kg * g_per_kg, 0, drawn_radius_mm,
                                     std::max(2 * center_of_mass_mm, 1.0));
  forearm->setName("forearm");
  forearm->setInertia(Vector::Constant(own_inertia_kgm2 * g_mm2_per_kg_m2));
  forearm->rotate(90, Vector::UnitX());
  addAngle("elbow", forearm->attachHinge(nullptr, Vector::Zero(), Vector::UnitZ(), -stop_deg, stop_deg));
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? 1 : -1;
    const Vector bottom = mountedEnd({side * lever_mm, lower_mm, 0}, {side, 0, 0});
    const Vector top = mountedStart({side * lever_mm, upper_mm, 0}, {side, 0, 0});
    auto* muscle = new Muscle(world, space(), top, top + (bottom - top) / 3, top + (bottom - top) * 2 / 3, bottom, minimum_mm, maximum_mm);
    muscle->connectStartTo(nullptr);
    muscle->connectEndTo(forearm);
    addActuator(muscle);
  }
  const Vector hand(0, -hand_mm, 0);
  setHand(forearm, forearm->getRotation().transpose() * (hand - forearm->getPosition()));
}

}  // namespace musclesim
