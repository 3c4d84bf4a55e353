#include "musclesim/robot/elbow.h"

#include <Eigen/Geometry>
#include <cmath>

#include "equilibrium.h"
#include "musclesim/error.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/simulation/simulation.h"
#include "musclesim/units.h"

namespace musclesim {

Elbow::Elbow(Simulation& simulation) : Robot(simulation) {
  forearm_kg_ = parameter("elbow.forearm_kg", 0.6, "kg", 1e-4, 1e3, "mass of the forearm");
  const double inertia_kgm2 =
      parameter("elbow.forearm_inertia_kgm2", 0.0125, "kg m^2", 1e-7, 1e3, "moment of inertia of the forearm about the hinge");
  center_of_mass_mm_ = parameter("elbow.center_of_mass_mm", 120, "mm", 0, 1e4, "distance of the forearm's centre of mass from the hinge");
  const double minimum_mm = parameter("elbow.minimum_length_mm", 150, "mm", 15, 1e4, "both muscles: shortest length");
  const double maximum_mm = parameter("elbow.maximum_length_mm", 320, "mm", 15, 1e4, "both muscles: longest length");
  stop_deg_ = parameter("elbow.stop_deg", 70, "deg", 0, 170, "joint stops at minus and plus this angle");
  const double hand_mm = parameter("elbow.hand_mm", 250, "mm", 0, 1e4, "distance of the hand from the hinge");
  lever_mm_ = parameter("elbow.lever_mm", 35, "mm", 0, 1e3, "distance of the attachments from the middle plane");
  lower_mm_ = parameter("elbow.lower_attachment_mm", -20, "mm", -1e3, 1e3, "height of the attachments on the forearm at angle 0");
  upper_mm_ = parameter("elbow.upper_attachment_mm", 240, "mm", 1, 1e4, "height of the attachments in the world");

  constexpr double drawn_radius_mm = 12;
  const double own_inertia_kgm2 = inertia_kgm2 - forearm_kg_ * std::pow(center_of_mass_mm_ / mm_per_m, 2);
  if (!(own_inertia_kgm2 > 0))
    throw BadParameter("elbow.forearm_inertia_kgm2", std::to_string(inertia_kgm2) + " kg m^2",
                       "be larger than forearm_kg * center_of_mass_mm^2, the inertia of a point mass there");
  forearm_ = new CappedCylinder(world(), nullptr, {0, -center_of_mass_mm_, 0}, forearm_kg_ * g_per_kg, 0, drawn_radius_mm,
                                std::max(2 * center_of_mass_mm_, 1.0));
  forearm_->setName("forearm");
  forearm_->setInertia(Vector::Constant(own_inertia_kgm2 * g_mm2_per_kg_m2));
  forearm_->rotate(90, Vector::UnitX());
  addAngle("elbow", forearm_->attachHinge(nullptr, Vector::Zero(), Vector::UnitZ(), -stop_deg_, stop_deg_));
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? 1 : -1;
    const Vector top = upperAttachment(side), bottom = lowerAttachment(side, 0);
    muscles_[i] = new Muscle(world(), space(), top, top + (bottom - top) / 3, top + (bottom - top) * 2 / 3, bottom, minimum_mm, maximum_mm);
    muscles_[i]->connectStartTo(nullptr);
    muscles_[i]->connectEndTo(forearm_);
    addActuator(muscles_[i]);
  }
  const Vector hand(0, -hand_mm, 0);
  setHand(forearm_, forearm_->getRotation().transpose() * (hand - forearm_->getPosition()));
}

Vector Elbow::upperAttachment(double side) const {
  return {side * lever_mm_, upper_mm_, 0};
}

Vector Elbow::lowerAttachment(double side, double angle_rad) const {
  return Eigen::AngleAxisd(angle_rad, Vector::UnitZ()) * Vector(side * lever_mm_, lower_mm_, 0);
}

double Elbow::torqueNmm(double angle_rad, const Action& command) const {
  const double gravity = simulation().physics().gravity_mm_per_s2 / simulation().physics().force_per_N;  // N/g
  double torque = -forearm_kg_ * g_per_kg * gravity * center_of_mass_mm_ * std::sin(angle_rad);
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? 1 : -1;
    const Vector lower = lowerAttachment(side, angle_rad);
    const Vector along = upperAttachment(side) - lower;
    const Vector pull = muscles_[i]->calculateForce(command[static_cast<std::size_t>(i)], along.norm()) * along.normalized();
    const Vector half_weight(0, -muscles_[i]->massG() / 2 * gravity, 0);
    torque += lower.cross(pull + half_weight).z();
  }
  return torque;
}

void Elbow::settle(const Action& first_command) {
  step(first_command);
  const double stop_rad = stop_deg_ * rad_per_deg;
  const double angle = rootBetween([&](double q) { return -torqueNmm(q, first_command); }, -stop_rad, stop_rad);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vector::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d hanging = Eigen::AngleAxisd(90 * rad_per_deg, Vector::UnitX()).toRotationMatrix();
  forearm_->place(turn * Vector(0, -center_of_mass_mm_, 0), turn * hanging);
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? 1 : -1;
    muscles_[i]->placeStraight(upperAttachment(side), lowerAttachment(side, angle));
  }
}

}  // namespace musclesim
