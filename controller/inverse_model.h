/// The inverse of a robot's clean model: the difference of pressure that moves a joint as wanted.
#pragma once

#include <memory>
#include <vector>

#include "../robot/resting_forces.h"
#include "../robot/skeleton.h"
#include "clean_model.h"

namespace musclesim {

/// Antagonists at one joint: p_i = level_i + sense_i u, limited to 0..1, with |u| <= largest.
struct Antagonism {
  const Action& level;
  const std::vector<double>& sense;
  double largest;
};

/// Solves  Q_j(q; u) = M_j(q) a_j  for u: Q_j generalised force of all muscles, by their force laws and moment arms, and of all weights
/// (RestingForces), N mm; M_j = sum over bodies of m |dx/dq_j|^2 + (dphi/dq_j) . I dphi/dq_j, the inertia that the joint's own motion
/// meets, without that of the muscles; a_j its angular acceleration. Friction, the other joints' accelerations and terms with the square of
/// the speed are left out.
class InverseModel {
 public:
  /// Throws BadParameter for a robot that cannot be built by its name, and as Skeleton and RestingForces do.
  explicit InverseModel(const Robot& robot);

  /// `angle`: place of the joint among the robot's angles; angle_deg: all of them. Returns the end of the range if no u is enough.
  double difference(std::size_t angle, const std::vector<double>& angle_deg, double acceleration_deg_per_s2, const Antagonism& muscles);
  /// The acceleration that a joint at rest has per small difference: b_j = (dQ_j/du) / M_j at u of the pose's own equilibrium, deg/s^2.
  double accelerationPerDifference(std::size_t angle, const std::vector<double>& angle_deg, const Antagonism& muscles);

 private:
  void setPose(const std::vector<double>& angle_deg);
  double force(const Antagonism& muscles, double u, Eigen::Index coordinate);
  double inertia(Eigen::Index coordinate);

  CleanModel model_;
  Skeleton skeleton_;
  RestingForces forces_;
  std::vector<Eigen::Index> coordinate_of_;  ///< of each angle
  Eigen::VectorXd q_, generalised_;
};

}  // namespace musclesim
