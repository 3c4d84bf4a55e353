/// Actuators pull between two primitives: a chain of links, each two beads on a slider, neighbouring links joined by hinges.
///
/// Created with `new` as in the paper and owned by the simulation whose world they are built in; do not delete them.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <string>
#include <vector>

#include "musclesim/color.h"
#include "musclesim/robot/force_law.h"
#include "musclesim/robot/joint.h"
#include "musclesim/robot/state.h"

namespace musclesim {

class Primitive;
class Simulation;

/// Numbers of all bead chains, read from the parameters "muscle.*".
struct MuscleSettings {
  explicit MuscleSettings(Parameters& parameters);
  double bead_radius_mm;  ///< a link is never shorter than two radii
  double bead_mass_g;
  double slider_friction_N;  ///< dry friction of each slider
  double hinge_friction_Nm;  ///< dry friction of each hinge
  double hinge_limit_deg;    ///< stops of each hinge at full length; they close in proportion to the length ratio
  double hinge_bounce_ratio;
};

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
class Actuator {
 public:
  virtual ~Actuator();
  Actuator(const Actuator&) = delete;
  Actuator& operator=(const Actuator&) = delete;

  /// Ball joint between the chain's first or last point and a primitive (null: the environment).
  /// Throws BadParameter if that end is already connected.
  void connectStartTo(Primitive* primitive);
  void connectEndTo(Primitive* primitive);

  /// Tension in N, pulling positive, at a pressure (fraction of full scale) and a length. The default asks the force law (Eq. 1
  /// unless "force_law.name" says otherwise); a user's own actuator overrides it. A result that is not finite stops the run.
  virtual double calculateForce(double pressure_ratio, double length_mm) const;

  /// Throws BadParameter unless the pressure is finite and lies in 0..1.
  void setPressure(double command_ratio);
  /// Throws BadParameter for null.
  void setForceLaw(std::unique_ptr<ForceLaw> law);
  void setColor(double red, double green, double blue, const std::string& name = "");
  void setName(const std::string& name);

  double command() const { return command_ratio_; }
  double pressure() const { return pressure_ratio_; }
  double tensionN() const { return tension_N_; }
  double lengthMm() const;
  /// (l - l_min) / (l_max - l_min); the shortest length is link count * 2 bead radii for chains of several links.
  double lengthRatio() const;
  double minimumLengthMm() const { return minimum_length_mm_; }
  double maximumLengthMm() const { return maximum_length_mm_; }
  double massG() const;
  const Color& color() const { return color_; }
  const std::string& name() const { return name_; }
  const std::vector<Link>& links() const { return links_; }
  const std::vector<Joint*>& hinges() const { return hinges_; }
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

  /// Pressure stage: the pressure that is now in the muscle, fraction of full scale.
  void takePressure(double pressure_ratio) { pressure_ratio_ = pressure_ratio; }
  /// Force stage: tension from pressure and length at present; where effects act on it, the tension that they make of it.
  void updateTension();
  void takeTension(double tension_N) { tension_N_ = tension_N; }
  /// Hands the tension to the sliders and sets the hinges' stops, for ODE's steppers.
  void applyForces();
  /// The hinges' stops at present, at minus and plus this angle.
  double hingeStopRad() const;

 protected:
  /// `points` are the chain's link ends, link count + 1 of them. `given_minimum_length_mm` is what the user asked for.
  /// Throws BadParameter if the length along the points is not between the given minimum and the maximum, or a link is shorter than its
  /// beads.
  Actuator(dWorldID world, dSpaceID space, const std::vector<Vector>& points, double given_minimum_length_mm, double minimum_length_mm,
           double maximum_length_mm);

 private:
  void buildLinks(dSpaceID beads, const std::vector<Vector>& points);
  Joint* connect(dBodyID bead, const Vector& anchor, Primitive* primitive, const std::string& which);

  Simulation& simulation_;
  MuscleSettings settings_;
  double minimum_length_mm_, maximum_length_mm_;
  std::unique_ptr<ForceLaw> law_;
  std::vector<Link> links_;
  std::vector<Joint*> hinges_;
  Joint* start_joint_ = nullptr;
  Joint* end_joint_ = nullptr;
  Vector start_mm_, end_mm_;
  double command_ratio_ = 0, pressure_ratio_ = 0, tension_N_ = 0;
  Color color_;
  std::string name_;
};

}  // namespace musclesim
