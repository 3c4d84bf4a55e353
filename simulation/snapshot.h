/// Everything to draw at one moment of a simulation.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/color.h"
#include "musclesim/robot/primitive.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

/// A bone: its shape and pose.
struct DrawnPart {
  Shape::Kind kind;
  Eigen::Vector3f size_mm;
  Eigen::Matrix4f pose;  ///< from the part's frame to the world, mm
  Color color;
  int primitive = -1;  ///< its number in World::primitives(); -1: it is none of them
};

/// A muscle: the control points of its centre line, from attachment to attachment.
struct DrawnHose {
  std::vector<Eigen::Vector3f> points_mm;
  float radius_mm;
  Color color;
  double tension_N;
  double minimum_length_mm, maximum_length_mm, length_mm;
};

/// A spring between two points, as the line of its wire: a coil, or straight if it is a rope.
struct DrawnSpring {
  std::vector<Eigen::Vector3f> points_mm;
  float radius_mm;  ///< of the wire
  Color color;
};

/// A pose that is drawn as a translucent ghost: the bones and muscles as they were measured.
struct DrawnGhost {
  std::vector<DrawnPart> parts;  ///< in the order of the snapshot's own
  std::vector<DrawnHose> hoses;
};

/// A point with axes and a name: a joint or the hand.
struct DrawnFrame {
  std::string name;
  Eigen::Matrix4f pose;
};

struct DrawnTarget {
  Eigen::Vector3f point_mm;
  bool is_height;  ///< only the height counts

  /// Where it is after a move to this point.
  Eigen::Vector3f movedTo(const Eigen::Vector3f& to_mm) const {
    return is_height ? Eigen::Vector3f(point_mm.x(), to_mm.y(), point_mm.z()) : to_mm;
  }
};

/// Where two bodies touch. The force between them is not known to all steppers.
struct DrawnContact {
  Eigen::Vector3f point_mm, normal;
};

/// A pull from outside: from the held point to the hand that pulls.
struct DrawnPull {
  Eigen::Vector3f point_mm, towards_mm;
  double force_N;
};

/// A copy of the state, taken between two steps. Drawing it needs no simulation, so another thread may draw it.
struct Snapshot {
  State state;
  std::vector<std::string> angle_names;  ///< of the state's angles
  std::optional<double> activity;
  std::vector<DrawnPart> parts;
  std::vector<DrawnHose> hoses;
  std::vector<DrawnSpring> springs;
  std::vector<DrawnFrame> frames;
  std::optional<DrawnTarget> target;
  std::vector<DrawnContact> contacts = {};
  std::optional<DrawnPull> pull = {};
  std::optional<float> floor_mm;                      ///< height of the ground plane, if there is one
  std::shared_ptr<const DrawnGhost> ghost = nullptr;  ///< null: there is none
};

/// Takes snapshots of one simulation without changing it. The caller passes the readings, since taking readings would advance random
/// streams.
class SnapshotTaker {
 public:
  explicit SnapshotTaker(Simulation& simulation);
  /// `state`: the readings of the moment.
  Snapshot take(const State& state);

 private:
  std::optional<DrawnTarget> target(const State& state);

  Simulation& simulation_;
  std::vector<Color> muscle_colors_;
  std::optional<Vector> first_hand_mm_;
};

/// A box around everything in a snapshot, with its ghost, mm: least and greatest x, y, z.
struct Bounds {
  Eigen::Vector3f low, high;
};
Bounds boundsOf(const Snapshot& snapshot);

/// The largest distance between the centres of a bone and of its ghost, mm. Without bones: between the ends of the muscles.
/// Nothing without a ghost.
std::optional<double> distanceOfGhostMm(const Snapshot& snapshot);

}  // namespace musclesim
