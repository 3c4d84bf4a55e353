#include "musclesim/robot/wrist.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "equilibrium.h"
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
  center_of_mass_mm_ = parameter("wrist.center_of_mass_mm", 60, "mm", 0, 1e4, "distance of the hand's centre of mass from the hinge");
  const double inertia_kgm2 =
      parameter("wrist.own_inertia_kgm2", 0.0005, "kg m^2", 1e-7, 1e3, "moment of inertia of the hand about its centre of mass");
  const double low_deg = parameter("wrist.low_stop_deg", -2, "deg", -170, 0, "joint stop below");
  const double high_deg = parameter("wrist.high_stop_deg", 90, "deg", 0, 170, "joint stop above");
  constexpr double drawn_radius_mm = 12;
  hand_ = new CappedCylinder(world(), nullptr, {center_of_mass_mm_, 0, 0}, hand_kg * g_per_kg, 0, drawn_radius_mm,
                             std::max(2 * center_of_mass_mm_, 1.0));
  hand_->setName("hand");
  hand_->setInertia(Vector::Constant(inertia_kgm2 * g_mm2_per_kg_m2));
  hand_->rotate(90, Vector::UnitY());
  hinge_ = hand_->attachHinge(nullptr, Vector::Zero(), Vector::UnitZ(), low_deg, high_deg);
  addAngle("wrist", hinge_);
  setHand(hand_);
}

void Wrist::buildMuscle(int i) {
  const double length_mm = parameter("wrist.muscle_length_mm", 200, "mm", 20, 1e4, "length of the muscles at wrist.middle_deg");
  const double minimum_mm = parameter("wrist.minimum_length_mm", 120, "mm", 15, 1e4, "both muscles: shortest length");
  const double maximum_mm = parameter("wrist.maximum_length_mm", 260, "mm", 15, 1e4, "both muscles: longest length, a stop");
  const double rest_mm = parameter(fmt::format("wrist.rest_length_{}_mm", i), 215, "mm", 20, 1e4,
                                   fmt::format("muscle {}: length at which it matches the force law's rest length", i));
  const double side = i == 0 ? 1 : -1;
  const Vector& bottom = lower_mm_[i] =
      mountedEnd(Eigen::AngleAxisd(-middle_rad_, Vector::UnitZ()) * Vector(side * lever_mm_, 0, 0), {side, 0, 0});
  const Vector& top = upper_mm_[i] = mountedStart({side * lever_mm_, length_mm, 0}, {side, 0, 0});
  muscles_[i] = new Muscle(world(), space(), top, top + (bottom - top) / 3, top + (bottom - top) * 2 / 3, bottom, minimum_mm, maximum_mm);
  muscles_[i]->setForceLaw(makeForceLaw(world().parameters(), minimum_mm, rest_mm));
  muscles_[i]->connectStartTo(nullptr);
  muscles_[i]->connectEndTo(hand_);
  addActuator(muscles_[i]);
}

Vector Wrist::leverEnd(int muscle, double angle_rad) const {
  return Eigen::AngleAxisd(angle_rad, Vector::UnitZ()) * lower_mm_[muscle];
}

void Wrist::placeHand(double angle_rad) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle_rad, Vector::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d pointing = Eigen::AngleAxisd(90 * rad_per_deg, Vector::UnitY()).toRotationMatrix();
  const Vector hinge_in_hand = hinge_->reference().anchor[0];
  hand_->place(turn * pointing * -hinge_in_hand, turn * pointing);
}

double Wrist::torqueNmm(double angle_rad) {
  placeHand(angle_rad);
  RobotEffects& effects = world().effects();
  const Vector gravity = world().gravityMmPerS2() / world().physics().force_per_N;  // N/g
  dMass mass;
  dBodyGetMass(hand_->body().id, &mass);
  const BodyLoad load = effects.restingLoad(*hand_);
  double torque = (hand_->getPosition().cross(mass.mass * gravity + load.force_N) + load.torque_Nmm).z();
  for (int i = 0; i < 2; ++i) {
    const Vector lower = leverEnd(i, angle_rad), along = upper_mm_[i] - lower;
    const Vector pull = effects.restingTensionN(i, along.norm()) * along.normalized() + muscles_[i]->massG() / 2 * gravity;
    torque += lower.cross(pull).z();
  }
  return torque;
}

void Wrist::settle() {
  const double low_rad = dJointGetHingeParam(hinge_->id(), dParamLoStop), high_rad = dJointGetHingeParam(hinge_->id(), dParamHiStop);
  const double angle = restFrom([&](double q) { return -torqueNmm(q); }, 0, low_rad, high_rad);
  placeHand(angle);
  for (int i = 0; i < 2; ++i) muscles_[i]->placeStraight(upper_mm_[i], leverEnd(i, angle));
}

}  // namespace musclesim
