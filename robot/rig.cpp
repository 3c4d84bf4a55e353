#include "musclesim/robot/rig.h"

#include "musclesim/base/units.h"
#include "musclesim/robot/muscle.h"

namespace musclesim {

Rig::Rig(World& world) : Robot(world) {
  const double minimum_mm = parameter("rig.minimum_length_mm", 120, "mm", 15, 1e4, "muscle: shortest length");
  const double maximum_mm = parameter("rig.maximum_length_mm", 300, "mm", 15, 1e4, "muscle: longest length");
  const double load_kg = parameter("rig.load_kg", 2.0, "kg", 1e-4, 1e3, "mass hanging from the muscle");
  const Vector bottom(0, -(minimum_mm + maximum_mm) / 2, 0);
  const Vector top = mountedStart({0, 0, 0}, Vector::UnitX());
  auto* muscle = new Muscle(world, space(), top, top + (bottom - top) / 3, top + (bottom - top) * 2 / 3, bottom, minimum_mm, maximum_mm);
  constexpr double drawn_radius_mm = 20;
  auto* load = new Sphere(world, nullptr, bottom, load_kg * g_per_kg, 0, drawn_radius_mm);
  load->setName("load");
  load->attachSlider(nullptr, Vector::UnitY());
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(load);
  addActuator(muscle);
  setLoad(load);
}

}  // namespace musclesim
