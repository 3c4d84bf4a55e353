#include "musclesim/robot/wrist.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "musclesim/base/units.h"
#include "musclesim/robot/force_law_choice.h"
#include "musclesim/robot/muscle.h"

namespace musclesim {

Wrist::Wrist(World& world) : Robot(world) {
  lever_mm_ = parameter("wrist.lever_mm", 25, "mm", 1, 1e3, "distance of the muscles' ends from the hinge");
  middle_rad_ = parameter("wrist.middle_deg", 35, "deg", -90, 90, "angle at which the lever lies across the muscles") * rad_per_deg;
  buildHand();
  for (int i = 0; i < 2; ++i) buildMuscle(i);
}

void Wrist::buildHand() {
  const double hand_kg = parameter("wrist.hand_kg", 0.3, "kg", 1e-4, 1e3, "mass of the hand");
  const double center_of_mass_mm =
      parameter("wrist.center_of_mass_mm", 60, "mm", 0, 1e4, "distance of the hand's centre of mass from the hinge");
  const double inertia_kgm2 =
      parameter("wrist.own_inertia_kgm2", 0.0005, "kg m^2", 1e-7, 1e3, "moment of inertia of the hand about its centre of mass");
  const double low_deg = parameter("wrist.low_stop_deg", -2, "deg", -170, 0, "joint stop below");
  const double high_deg = parameter("wrist.high_stop_deg", 90, "deg", 0, 170, "joint stop above");
  constexpr double drawn_radius_mm = 12;
  hand_ = new CappedCylinder(world(), nullptr, {center_of_mass_mm, 0, 0}, hand_kg * g_per_kg, 0, drawn_radius_mm,
                             std::max(2 * center_of_mass_mm, 1.0));
  hand_->setName("hand");
  hand_->setInertia(Vector::Constant(inertia_kgm2 * g_mm2_per_kg_m2));
  hand_->rotate(90, Vector::UnitY());
  addAngle("wrist", hand_->attachHinge(nullptr, Vector::Zero(), Vector::UnitZ(), low_deg, high_deg));
  setHand(hand_);
}

void Wrist::buildMuscle(int i) {
  const double length_mm = parameter("wrist.muscle_length_mm", 200, "mm", 20, 1e4, "length of the muscles at wrist.middle_deg");
  const double minimum_mm = parameter("wrist.minimum_length_mm", 120, "mm", 15, 1e4, "both muscles: shortest length");
  const double maximum_mm = parameter("wrist.maximum_length_mm", 260, "mm", 15, 1e4, "both muscles: longest length, a stop");
  const double rest_mm = parameter(fmt::format("wrist.rest_length_{}_mm", i), 215, "mm", 20, 1e4,
                                   fmt::format("muscle {}: length at which it matches the force law's rest length", i));
  const double side = i == 0 ? 1 : -1;
  const Vector bottom = mountedEnd(Eigen::AngleAxisd(-middle_rad_, Vector::UnitZ()) * Vector(side * lever_mm_, 0, 0), {side, 0, 0});
  const Vector top = mountedStart({side * lever_mm_, length_mm, 0}, {side, 0, 0});
  auto* muscle = new Muscle(world(), space(), top, top + (bottom - top) / 3, top + (bottom - top) * 2 / 3, bottom, minimum_mm, maximum_mm);
  muscle->setForceLaw(makeForceLaw(world().parameters(), minimum_mm, rest_mm));
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(hand_);
  addActuator(muscle);
}

}  // namespace musclesim
