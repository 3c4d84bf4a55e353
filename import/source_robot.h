/// A robot as another program describes it: bodies, joints, pulleys, muscles and springs in the frames and units of the source (z up, m,
/// kg, rad). The importers of the formats fill it; prepare() makes of it what a robot here can have; robot_writer.h writes it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "mass_properties.h"
#include "source_shape.h"

namespace musclesim {

struct SourceRange {
  double low = 0, high = 0;
};

struct SourceBody {
  std::string name = {};
  Pose pose = Pose::Identity();  ///< of its frame in the world, pose as built
  MassProperties mass = {};      ///< in its frame
  std::vector<SourceShape> shapes = {};
  bool collides = false;
  bool free = false;            ///< no joint holds it
  bool fixed = false;           ///< to the world: it is drawn, and what refers to it refers to the world
  bool gone = false;            ///< a part of another body by now
  std::size_t carrier_for = 0;  ///< not 0: stands between two joints of that body and gets a small share of its mass
};

/// Holds `body` against `to`. Positions and limits count from the pose as built. Units: m or rad, N or N m, and so on.
struct SourceJoint {
  enum class Kind { fixed, hinge, slider, universal, ball };
  std::string name = {};
  Kind kind = Kind::fixed;
  std::size_t body = 0, to = 0;
  Eigen::Vector3d anchor_m = Eigen::Vector3d::Zero();  ///< in the frame of `body`
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();     ///< in the frame of `body`: it turns or moves right-handed against `to`
  Eigen::Vector3d axis2 = Eigen::Vector3d::UnitX();    ///< universal: in the frame of `to`
  std::optional<SourceRange> limits = {}, limits2 = {};
  double friction = 0, damping = 0, stiffness = 0, rest = 0;
};

/// A point that is fixed to a body, in the body's frame.
struct SourcePoint {
  std::size_t body = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

/// A cylinder along the z axis of its pose, or a sphere, that muscles wrap around.
struct SourcePulley {
  std::string name = {};
  std::size_t body = 0;
  Pose pose = Pose::Identity();
  double radius_m = 0;
  bool sphere = false;
};

/// What the path of a muscle passes: a point, or a pulley on the side of a point.
struct SourceStation {
  std::optional<std::size_t> pulley;
  std::optional<SourcePoint> point;  ///< on a pulley: the side
};

struct SourceMuscle {
  std::string name = {};
  std::vector<SourceStation> path;  ///< the first and the last are points
  double tendon_m = 0;              ///< a cable in series: length of the muscle = length of the path - tendon
  std::optional<SourceRange> length_m;
  std::optional<std::array<double, 3>> color;
};

struct SourceSpring {
  std::string name = {};
  SourcePoint from, to;
  double stiffness = 0, damping = 0;
  std::optional<double> rest_m;  ///< default: the length as built
};

struct SourceRobot {
  SourceRobot();

  std::string name, format;        ///< format: "URDF", "SDF" or "MJCF"
  std::string file;                ///< for messages
  std::vector<SourceBody> bodies;  ///< bodies[0] is the world
  std::vector<SourceJoint> joints;
  std::vector<SourcePulley> pulleys;
  std::vector<SourceMuscle> muscles;
  std::vector<SourceSpring> springs;
  std::vector<std::string> notes;

  /// Holds body `child` to `parent` by several joints in series, the first at the parent; anchors and axes are in the child's frame. No
  /// joint: fixed. Two hinges that cross at right angles make a universal joint, three that meet in a point a ball joint. Other series get
  /// bodies of a small mass between their joints.
  void join(std::size_t parent, std::size_t child, std::vector<SourceJoint> series);

  /// Turns or moves everything that hangs on a hinge or slider, in its positive direction: the new pose is the pose as built.
  /// Does nothing and returns false if the joint belongs to a closed loop.
  bool move(const SourceJoint& joint, double amount);

  Eigen::Vector3d inWorld(const SourcePoint& point) const { return bodies[point.body].pose * point.position_m; }
};

/// The shapes of a link in a format that tells what touches from what is seen.
struct LinkShapes {
  std::vector<SourceShape> touching, seen;
  int mesh_count = 0;  ///< among both
};

/// Gives a body the shapes that touch. If there are none (or meshes only), it gets those that are seen; if these are meshes, too, the box
/// with its inertia. Says in the notes what becomes of meshes.
void giveShapes(SourceRobot& robot, SourceBody& body, const LinkShapes& shapes);

/// Makes a robot ready to be written: bodies held by fixed joints become one, the pose as built lies within all limits, every body has a
/// mass and an inertia that a body can have, names are unique. Says in the notes what it changed. Throws BadFile.
void prepare(SourceRobot& robot);

}  // namespace musclesim
