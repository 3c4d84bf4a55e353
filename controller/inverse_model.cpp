#include "inverse_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../robot/ode_vector.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"

namespace musclesim {

InverseModel::InverseModel(const Robot& robot) : model_(robot), skeleton_(model_.world()), forces_(model_.world(), skeleton_) {
  const auto& coordinates = skeleton_.coordinates();
  q_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coordinates.size()));
  generalised_ = q_;
  for (const Robot::Angle& angle : model_.robot().angles()) {
    const auto place =
        std::ranges::find_if(coordinates, [&](const Coordinate& c) { return c.joint == angle.joint && c.axis == angle.axis; });
    if (place == coordinates.end()) throw BadParameter(fmt::format("angle {} is no coordinate of the robot's tree of joints", angle.name));
    coordinate_of_.push_back(place - coordinates.begin());
  }
}

double InverseModel::force(const Antagonism& muscles, double u, Eigen::Index coordinate) {
  Action action = muscles.level;
  for (std::size_t i = 0; i < action.size(); ++i) action[i] = std::clamp(action[i] + muscles.sense[i] * u, 0.0, 1.0);
  model_.setPressures(action);
  forces_.at(q_, generalised_);
  return generalised_[coordinate];
}

double InverseModel::inertia(Eigen::Index coordinate) {
  constexpr double small_rad = 1e-4;  ///< the error of a central difference is of the order of its square
  std::vector<Vector> position;
  std::vector<Eigen::Matrix3d> rotation;
  const auto place = [&](double by) {
    Eigen::VectorXd q = q_;
    q[coordinate] += by;
    skeleton_.setPose(q);
    skeleton_.placeBodies();
  };
  place(-small_rad);
  for (int i = 0; i < skeleton_.bodyCount(); ++i) {
    position.push_back(positionOf(skeleton_.body(i).id));
    rotation.push_back(rotationOf(skeleton_.body(i).id));
  }
  place(small_rad);
  double inertia_g_mm2 = 0;
  for (int i = 0; i < skeleton_.bodyCount(); ++i) {
    const dBodyID body = skeleton_.body(i).id;
    const auto n = static_cast<std::size_t>(i);
    const Vector moved = (positionOf(body) - position[n]) / (2 * small_rad);
    const Eigen::Matrix3d turned = rotation[n].transpose() * rotationOf(body) / (2 * small_rad);
    const Vector turn(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0), turned(1, 0) - turned(0, 1));  // twice, in the body's frame
    dMass mass;
    dBodyGetMass(body, &mass);
    inertia_g_mm2 += mass.mass * moved.squaredNorm() + (turn / 2).dot(matrixFromOde(mass.I) * (turn / 2));
  }
  return inertia_g_mm2;
}

void InverseModel::setPose(const std::vector<double>& angle_deg) {
  for (std::size_t i = 0; i < coordinate_of_.size(); ++i) q_[coordinate_of_[i]] = angle_deg[i] * rad_per_deg;
}

double InverseModel::accelerationPerDifference(std::size_t angle, const std::vector<double>& angle_deg, const Antagonism& muscles) {
  constexpr double small = 0.01;  ///< of full scale: force laws are smooth over it
  const double u = difference(angle, angle_deg, 0, muscles);
  const Eigen::Index coordinate = coordinate_of_.at(angle);
  const double per_difference = (force(muscles, u + small, coordinate) - force(muscles, u - small, coordinate)) / (2 * small);
  return per_difference * model_.world().physics().force_per_N / inertia(coordinate) * deg_per_rad;
}

double InverseModel::difference(std::size_t angle, const std::vector<double>& angle_deg, double acceleration_deg_per_s2,
                                const Antagonism& muscles) {
  constexpr int halvings = 30;  ///< to 1e-9 of full scale
  setPose(angle_deg);
  const Eigen::Index coordinate = coordinate_of_.at(angle);
  const double wanted =
      acceleration_deg_per_s2 == 0 ? 0 : inertia(coordinate) * acceleration_deg_per_s2 * rad_per_deg / model_.world().physics().force_per_N;
  double low = -muscles.largest, high = muscles.largest;
  if (force(muscles, low, coordinate) >= wanted) return low;
  if (force(muscles, high, coordinate) <= wanted) return high;
  for (int i = 0; i < halvings; ++i) {
    const double middle = (low + high) / 2;
    (force(muscles, middle, coordinate) < wanted ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace musclesim
