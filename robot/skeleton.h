/// The kinematic tree of a world: its bodies and the joints between them, without the chains of muscles.
#pragma once

#include <ode/ode.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "musclesim/robot/robot_effects.h"
#include "musclesim/robot/world.h"

namespace musclesim {

/// A coordinate of a skeleton: the angle of a hinge or of one axis of a two-axis joint in rad, the position of a slider in mm, or one of
/// the three components of a ball joint's rotation vector in rad, in the frame of the body that the joint hangs on. All are 0 in the pose
/// as built; angles and positions count as those of Joint::angleDeg and of ODE's sliders.
struct Coordinate {
  const Joint* joint;
  int axis;          ///< of the joint
  bool turns;        ///< true: an angle, false: a position
  double low, high;  ///< the joint's stops; infinite where there are none

  bool locked() const { return low >= high; }
  /// "hinge of forearm and environment", or "axis 1 of universal joint of ...".
  std::string name() const;
};

/// Poses of all bodies from coordinates, and generalised forces from loads on bodies (virtual work).
///
/// The pose as built is that of the joints' references, so it is known wherever the bodies are now. The stops of ball joints and those
/// about the second axis of two-axis hinges belong to other joints of ODE and are left out.
class Skeleton {
 public:
  /// What becomes of a joint that closes a loop. Opened: ball joints become closures(), which a pose need not fulfil.
  enum class Loops { refused, opened };
  /// Throws BadParameter for a body that nothing holds and for joints that close a loop; the message names them.
  explicit Skeleton(const World& world, Loops loops = Loops::refused);

  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  /// Ball joints at which loops were opened.
  const std::vector<const Joint*>& closures() const { return closures_; }
  /// Coordinates after a small displacement: the sum, but rotation vectors of ball joints are composed.
  Eigen::VectorXd displaced(const Eigen::VectorXd& coordinates, const Eigen::VectorXd& by) const;
  /// Poses of all bodies; the bodies themselves stay where they are until placeBodies().
  void setPose(const Eigen::VectorXd& coordinates);
  void placeBodies() const;

  /// Bodies by number.
  int bodyCount() const { return static_cast<int>(bones_.size()); }
  const Body& body(int number) const { return *bones_[static_cast<std::size_t>(number)].body; }
  /// Number of a body; -1 for the environment and for beads.
  int numberOf(dBodyID id) const;
  /// A point that is fixed to a body, given from its centre of mass in its frame, or to the environment (-1), in the world.
  Vector pointMm(int number, const Vector& place) const;

  /// Takes all loads away but the weights, with gravity in N/g.
  void loadWithWeights(const Vector& gravity);
  /// Adds a force in N at a point of the world, or a force and a torque about the centre of mass. The environment (-1) takes everything.
  void addForce(int number, const Vector& force_N, const Vector& point_mm);
  void addLoad(int number, const BodyLoad& load);
  /// The work of all loads per displacement of each coordinate: N for positions, N mm for angles. Uses the loads up.
  void takeForces(Eigen::VectorXd& generalised);

 private:
  struct Bone {
    const Body* body;
    double mass_g;
    int parent;            ///< number of the body that it hangs on; -1: the environment
    const Joint* joint;    ///< on which it hangs
    int first_coordinate;  ///< those of its joint follow each other
    int coordinate_count;
    // The joint in the pose as built. Axes and anchor in the parent's frame; in this order, each axis turns with the angles before it.
    Vector axis[3];
    int coordinate_of_axis[3];  ///< counted from first_coordinate
    Vector anchor, anchor_in_bone;
    Vector offset;         ///< sliders and fixed joints: position in the parent's frame
    Eigen::Matrix3d turn;  ///< orientation in the parent's frame
    // Now, in the world.
    Vector position, anchor_now, axis_now[3];
    Eigen::Matrix3d rotation;
    Vector force_N, torque_Nmm;  ///< about the origin of the world
  };
  void addBones(const World& world, Loops loops);
  Bone boneOn(const Joint& joint, const Body& body, int parent);
  void addCoordinates(Bone& bone, bool is_first);
  void setPose(Bone& bone, const Eigen::VectorXd& coordinates) const;

  std::vector<Bone> bones_;  ///< a body stands behind the one that it hangs on
  std::vector<Coordinate> coordinates_;
  std::vector<const Joint*> closures_;
};

}  // namespace musclesim
