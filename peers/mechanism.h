/// A robot in the terms that every engine of rigid bodies has: bodies, joints, muscles. Read from the robot itself, in its present pose.
///
/// The engines' sources include this header, so it needs no C++20. Units are those of the other engines: m, kg, s, N, rad. The world's y
/// axis points up, as in musclesim.
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/robot/joint.h"

namespace musclesim {

class Actuator;
class Simulation;

namespace peers {

inline constexpr int environment = -1;
inline constexpr double unlimited = std::numeric_limits<double>::infinity();

struct RigidBody {
  std::string name;
  double mass_kg;
  Eigen::Matrix3d inertia_kg_m2;  ///< about the centre of mass, in the body's frame
  Vector position_m;              ///< of the centre of mass
  Eigen::Quaterniond rotation;
};

/// An axis of a hinge, a slider or a universal joint. Its coordinate is that of the first body against the second, 0 in the present pose.
struct JointAxis {
  Vector direction = Vector::Zero();  ///< in the world
  double low = -unlimited, high = unlimited;
  double friction = 0;  ///< dry: N or N m
  double damping = 0;   ///< viscous: N s/m or N m s/rad
};

struct BodyJoint {
  Joint::Kind kind;
  int first, second;               ///< bodies; the second may be the environment
  Vector anchor_m;                 ///< in the world
  std::vector<JointAxis> axes;     ///< hinge, slider: one; universal: the axis on the first body, then that on the second
  double coordinate_as_built = 0;  ///< of the first axis: in the present pose, counted from the pose as built
  const Joint* source = nullptr;
};

/// A frame for a joint. Columns: the axis as the x axis (of a slider: column 0) or as the z axis (of a hinge: column 2), and two directions
/// across.
inline Eigen::Matrix3d frameAlong(const Vector& axis, int column) {
  Eigen::Matrix3d frame;
  frame.col(column) = axis;
  frame.col((column + 1) % 3) = axis.unitOrthogonal();
  frame.col((column + 2) % 3) = axis.cross(frame.col((column + 1) % 3));
  return frame;
}

/// A point on a body, in its frame, or in the world.
struct BodyPoint {
  int body = environment;
  Vector place_m = Vector::Zero();
};

struct WrappingPulley {
  BodyPoint center;
  Vector axis;  ///< in the body's frame; zero: a sphere
  double radius_m;
  std::optional<Vector> side_m;  ///< in the body's frame
};

/// A muscle is a chain of joints or a line through points.
struct MuscleParts {
  const Actuator* actuator;
  std::vector<int> sliders = {}, hinges = {};  ///< joints of a chain, from its start
  int start_joint = -1, end_joint = -1;
  double length_m = 0;                 ///< in the present pose; that of a chain falls with the sum of its sliders' coordinates
  std::vector<BodyPoint> points = {};  ///< of a line
  std::vector<std::optional<WrappingPulley>> pulleys = {};  ///< between each point and the next one
};

struct Mechanism {
  std::vector<RigidBody> bodies;
  std::vector<BodyJoint> joints;
  std::vector<MuscleParts> muscles;
  BodyPoint hand;
  double gravity_m_per_s2 = 0;  ///< downwards, along -y

  Vector inWorld(const BodyPoint& point) const;
};

/// Two balls between the same two bodies become one hinge, which allows the same motion without a row that another one repeats. Throws
/// BadParameter for what the peers' models do not hold: two-axis hinges, springs, limits of balls.
Mechanism mechanismOf(Simulation& simulation);

/// A body and the joint through which it hangs on its parent, in the order in which a tree is built: parents first.
struct TreeNode {
  int body, parent;  ///< the parent may be the environment
  int joint;         ///< -1: the body is free
  bool reversed;     ///< the body is the joint's second one, so a positive coordinate moves it against the axis
};
struct Tree {
  std::vector<TreeNode> nodes;
  std::vector<int> loops;  ///< balls that remain: they close loops
};

/// The skeleton first; a chain hangs on that of its two bones which has fewer joints between it and the environment, and its other ball
/// closes a loop. Throws BadParameter where a loop is closed by another joint than a ball.
Tree spanningTree(const Mechanism& mechanism);

}  // namespace peers
}  // namespace musclesim
