/// Actuators pull between two primitives: a chain of links, each two beads on a slider, neighbouring links joined by hinges.
///
/// Created with `new` as in the paper and owned by the world in which they are built; do not delete them.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/color.h"
#include "musclesim/robot/force_law.h"
#include "musclesim/robot/joint.h"
#include "musclesim/robot/muscle_settings.h"
#include "musclesim/robot/state.h"
#include "musclesim/robot/world.h"

namespace musclesim {

class LineOfPull;
class Primitive;

/// One link: the bead at its start, the bead at its end and the slider between them (position 0 as built, positive when shorter).
struct Link {
  dBodyID bead[2];
  dGeomID geom[2];
  Joint* slider;
};

/// Something that pulls with a tension that depends on pressure and length.
///
/// Every internal step: pressure follows the command, tension = calculateForce(pressure, length), the tension acts on every slider of the
/// chain, and the hinges' stops are set to +-limit * (l - l_min)/(l_max - l_min).
/// Length l = sum of the distances of each link's two beads + link count * 2 bead radii.
///
/// With the parameter muscle.model = line there are no links: the tension acts along the straight line between the ends, or along its via
/// points and around its pulleys (LineOfPull), and is never negative. l is the length of that path without the tendon. Such a muscle has no
/// mass and touches nothing.
class Actuator : public WorldPart {
 public:
  ~Actuator() override;

  /// Ball joint between the chain's first or last point and a primitive (null: the environment).
  /// Throws BadParameter if that end is already connected.
  void connectStartTo(Primitive* primitive);
  void connectEndTo(Primitive* primitive);
  /// Lets a line muscle pass through a point that is fixed to a primitive (null: the environment), after those added before.
  /// Throws BadParameter for a chain, and once the path is finished.
  void addViaPoint(Primitive* primitive, const Vector& point_mm);
  /// Lets a line muscle pass a pulley that is fixed to a primitive (null: the environment), after the via points added before: a cylinder
  /// without ends about an axis, or a sphere if the axis is zero. The muscle lies on it where its straight segment would cross it; with a
  /// side point, fixed to the same primitive, it passes on the side of this point (Pulley has the rule). Points in mm in the world frame,
  /// in the pose as built. Throws BadParameter for a chain, once the path is finished, for a radius that is not positive, a side point
  /// inside the pulley, and a second pulley without a via point between.
  void addPulley(Primitive* primitive, const Vector& center_mm, const Vector& axis, double radius_mm,
                 const std::optional<Vector>& side_mm = {});
  /// Gives a line muscle an inextensible cable in series: muscle length = path length - tendon. Throws BadParameter for a chain, once the
  /// path is finished, and for a length that is negative or not finite.
  void setTendonMm(double tendon_mm);
  /// Says that the robot stands as built: a simulation does before the first step with this muscle. The path of a line muscle is finished
  /// then. Throws BadParameter if its length lies outside of the muscle's range, or a point of it inside a pulley. Does nothing the second
  /// time, and for chains, whose length the constructor has checked.
  void finishPath();

  /// Tension in N, pulling positive, at a pressure (fraction of full scale) and a length. The default asks the force law (Eq. 1
  /// unless "force_law.name" says otherwise); a user's own actuator overrides it. A result that is not finite stops the run.
  virtual double calculateForce(double pressure_ratio, double length_mm) const;

  /// Throws BadParameter unless the pressure is finite and lies in 0..1.
  void setPressure(double command_ratio);
  void requireCommand(double command_ratio) const;
  /// Throws BadParameter for null.
  void setForceLaw(std::unique_ptr<ForceLaw> law);
  void setColor(double red, double green, double blue, const std::string& name = "");
  void setName(const std::string& name);

  /// For Primitive::addPointMass: LineOfPull::moveCenter of a line muscle.
  void moveCenter(dBodyID body, const Vector& shift_mm);

  // The muscle's entry in World::values().
  double command() const { return world_.values().command_ratio[worldIndex()]; }
  double pressure() const { return world_.values().pressure_ratio[worldIndex()]; }
  double tensionN() const { return world_.values().tension_N[worldIndex()]; }
  double lengthMm() const;
  /// (l - l_min) / (l_max - l_min); the shortest length is link count * 2 bead radii for chains of several links.
  double lengthRatio() const;
  double minimumLengthMm() const { return minimum_length_mm_; }
  double maximumLengthMm() const { return maximum_length_mm_; }
  /// ForceLaw::restLengthMm and ForceLaw::contractedLengthMm of the muscle's law; the longest and the shortest length for laws without.
  /// What refers to these lengths does not change with a stop that is never reached.
  double restLengthMm() const { return law_->restLengthMm().value_or(maximum_length_mm_); }
  double contractedLengthMm() const { return law_->contractedLengthMm().value_or(minimum_length_mm_); }
  double massG() const;
  const Color& color() const { return color_; }
  const std::string& name() const { return name_; }
  const std::vector<Link>& links() const { return links_; }
  const std::vector<Joint*>& hinges() const { return hinges_; }
  /// The line of a line muscle, null for a chain.
  const LineOfPull* line() const { return line_.get(); }
  const MuscleSettings& settings() const { return settings_; }
  const World& world() const { return world_; }
  const ForceLaw& forceLaw() const { return *law_; }
  const Joint* startJoint() const { return start_joint_; }
  const Joint* endJoint() const { return end_joint_; }

  /// Shortest and longest length of the chain when all links are equally long, between the sliders' stops.
  struct LengthRange {
    double shortest_mm, longest_mm;
  };
  LengthRange straightLengthRange() const;

  /// Lays the chain along the straight line from start to end, all links equally long, at rest. Throws BadParameter if the line is shorter
  /// than the links' beads or not finite.
  void placeStraight(const Vector& start_mm, const Vector& end_mm);

  /// Tension at the present length without effects, N: calculateForce, but a line muscle never pushes.
  double cleanTensionN(double pressure_ratio) const;

 protected:
  /// `points` are the chain's link ends, link count + 1 of them. `given_minimum_length_mm` is what the user asked for.
  /// Throws BadParameter if a point is not finite and, for a chain, if the length along the points is not between the given minimum and the
  /// maximum, or a link is shorter than its beads. For a line muscle finishPath checks the length.
  Actuator(dWorldID world, dSpaceID space, const std::vector<Vector>& points, double given_minimum_length_mm, double minimum_length_mm,
           double maximum_length_mm, MuscleModel model = MuscleModel::by_parameter);

 private:
  void takeCleanTension();
  void requireStartLength(double length_mm, const std::string& which) const;
  LineOfPull& openPath(const std::string& what);
  void setFriction(dJointID joint, double force, double speed) const;
  void buildLinks(dSpaceID beads, const std::vector<Vector>& points);
  void requireSameWorld(const Primitive* primitive, const std::string& which) const;
  Joint* connect(dBodyID bead, const Vector& anchor, Primitive* primitive, const std::string& which);

  World& world_;
  MuscleSettings settings_;
  double given_minimum_length_mm_, minimum_length_mm_, maximum_length_mm_;
  std::unique_ptr<ForceLaw> law_;
  std::vector<Link> links_;
  std::vector<Joint*> hinges_;
  std::unique_ptr<LineOfPull> line_;
  bool path_finished_ = false;
  Joint* start_joint_ = nullptr;
  Joint* end_joint_ = nullptr;
  Vector start_mm_, end_mm_;
  Color color_;
  std::string name_;
};

}  // namespace musclesim
