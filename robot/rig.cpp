#include "musclesim/robot/rig.h"

#include <algorithm>
#include <cmath>

#include "equilibrium.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/muscle.h"

namespace musclesim {

Rig::Rig(World& world) : Robot(world) {
  const double minimum_mm = parameter("rig.minimum_length_mm", 120, "mm", 15, 1e4, "muscle: shortest length");
  const double maximum_mm = parameter("rig.maximum_length_mm", 300, "mm", 15, 1e4, "muscle: longest length");
  const double load_kg = parameter("rig.load_kg", 2.0, "kg", 1e-4, 1e3, "mass hanging from the muscle");
  const Vector bottom(0, -(minimum_mm + maximum_mm) / 2, 0);
  top_mm_ = mountedStart({0, 0, 0}, Vector::UnitX());
  const Vector& top = top_mm_;
  muscle_ = new Muscle(world, space(), top, top + (bottom - top) / 3, top + (bottom - top) * 2 / 3, bottom, minimum_mm, maximum_mm);
  constexpr double drawn_radius_mm = 20;
  load_ = new Sphere(world, nullptr, bottom, load_kg * g_per_kg, 0, drawn_radius_mm);
  load_->setName("load");
  load_->attachSlider(nullptr, Vector::UnitY());
  muscle_->connectStartTo(nullptr);
  muscle_->connectEndTo(load_);
  addActuator(muscle_);
  setLoad(load_);
}

void Rig::settle() {
  RobotEffects& effects = world().effects();
  const double gravity = -world().gravityMmPerS2().y() / world().physics().force_per_N;  // N/g
  dMass load;
  dBodyGetMass(load_->body().id, &load);
  const double weight_N = (load.mass + muscle_->massG() / 2) * gravity;
  const auto stops = muscle_->straightLengthRange();
  // The load hangs that far below the start when the muscle has a length.
  auto depth = [&](double length_mm) { return std::sqrt(length_mm * length_mm - top_mm_.x() * top_mm_.x()); };
  auto surplus = [&](double length_mm) {
    load_->place({0, top_mm_.y() - depth(length_mm), 0}, Eigen::Matrix3d::Identity());
    return effects.restingTensionN(0, length_mm) * depth(length_mm) / length_mm + effects.restingLoad(*load_).force_N.y() - weight_N;
  };
  const double length_mm = rootBetween(surplus, stops.shortest_mm, stops.longest_mm);
  const Vector bottom(0, top_mm_.y() - depth(length_mm), 0);
  load_->place(bottom, Eigen::Matrix3d::Identity());
  muscle_->placeStraight(top_mm_, bottom);
}

}  // namespace musclesim
