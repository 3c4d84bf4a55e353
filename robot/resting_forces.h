/// All forces on a robot at rest as generalised forces on its skeleton, without friction.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "musclesim/robot/world.h"
#include "skeleton.h"

namespace musclesim {

/// Weights, effects, force elements and muscles, by virtual work:
///     Q_i = sum over bodies of (F . dx/dq_i + M . dphi/dq_i) - sum over muscles of T dl/dq_i
/// Q_i generalised force of the coordinate q_i (N for mm, N mm for rad), F and M force in N and torque in N mm on a body, x and phi its
/// position and rotation, T tension of a muscle in N and l its length in mm. A chain runs straight from its start to its end, and each
/// end carries half of its weight. A line muscle never pushes; beyond its longest length a spring adds to its tension (LineOfPull).
///
/// A chain also stops at the shortest and the longest length that its links allow. Such a stop is a spring whose force is corrected until
/// the length is no longer beyond the stop (the method of multipliers):
///     S = max(0, s + k (l - l_max)) - max(0, s' + k (l_min - l)),   T = resting tension + S
/// k stiffness of the stops in N/mm, s and s' corrections in N, 0 at first.  Source: Nocedal & Wright, Numerical Optimization, Ch. 17.
class RestingForces {
 public:
  /// Throws BadParameter for a chain with a loose end.
  RestingForces(World& world, Skeleton& skeleton);

  /// Places the bodies and evaluates the forces on all coordinates; `generalised` has their number.
  void at(const Eigen::VectorXd& coordinates, Eigen::VectorXd& generalised);
  /// Sum of the amounts of all forces of the last at(), N: a scale for what is small.
  double typicalForceN() const;

  struct Beyond {
    const Actuator* muscle = nullptr;
    double by_mm = 0;
  };
  /// Corrects the forces of the chains' stops by what the last at() found. Returns the largest change over the stiffness: the chain that is
  /// farthest beyond a stop, and how far.
  Beyond correctStops();
  void stiffenStops(double factor) { stop_N_per_mm_ *= factor; }
  /// Throws BadParameter if the ends of a chain were nearer to each other in the last at() than its links allow when straight.
  void requireChainsFit() const;
  /// Lays all chains along their straight lines in the pose of the last at().
  void layMuscles() const;

 private:
  struct End {
    int body = -1;
    Vector place = Vector::Zero();  ///< as Skeleton::pointMm takes it
  };
  struct Pull {
    Actuator* actuator;
    int number;  ///< in World::actuators()
    End start, end;
    Vector half_weight_N;
    double shortest_mm, longest_mm;
    double longest_stop_N = 0, shortest_stop_N = 0;  ///< s and s'
    double length_mm = 0, tension_N = 0, stop_N = 0;
  };
  Pull pullOf(Actuator& actuator, int number) const;
  End endAt(const Joint* joint, const Actuator& actuator, const std::string& which) const;
  double stopN(const Pull& pull) const;
  void addChain(Pull& pull);
  void addLine(Pull& pull);
  void addOtherLoads();

  World& world_;
  Skeleton& skeleton_;
  Vector gravity_;  ///< N/g
  std::vector<Pull> pulls_;
  double weight_N_ = 0;
  double load_N_ = 0;  ///< amounts of effects and force elements
  double stop_N_per_mm_;
};

}  // namespace musclesim
