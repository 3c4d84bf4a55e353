/// Robots: primitives and actuators that report a state and take an action.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/base/color.h"
#include "musclesim/base/parameters.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/muscle.h"
#include "musclesim/robot/primitive.h"
#include "musclesim/robot/robot_effects.h"
#include "musclesim/robot/state.h"
#include "musclesim/robot/world.h"

namespace musclesim {

/// A user's robot is a subclass that builds its parts in the constructor:
///     class MyJoint : public Robot { public: explicit MyJoint(World& world) : Robot(world) { ... } };
/// registerRobot (robot_registry.h) gives it a name.
class Robot {
 public:
  explicit Robot(World& world) : world_(world) {}
  virtual ~Robot() = default;
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  /// Sensor stage: the readings at present. Lengths, angles and positions are those of the time; pressures and forces those after the last
  /// command began to act. Without effects of this stage they are the truth.
  virtual State getState() const;
  /// The true state at present.
  State truth() const;
  /// Command stage: sets the pressures that hold until the next call. Throws BadParameter for a wrong number of them or one outside 0..1,
  /// Diverged for one that is not finite.
  virtual void step(const Action& action);

  /// Puts the robot at rest at the frictionless equilibrium that it reaches from the pose as built under the pressures that are in its
  /// muscles. The default does it for every robot whose joints form a tree, with straight chains, without contacts, and without the stops
  /// of ball joints and of the second axis of two-axis hinges. It throws BadParameter, with the name of the part, for loops of joints,
  /// bodies that no joint holds, chains that run in a curve or have a loose end, and where there is no equilibrium.
  virtual void settle();
  /// How runs begin unless told otherwise: "built" or "settled".
  virtual std::string initialState() const { return "built"; }

  /// What is known of numbers of the model that were measured with an error: relative standard deviation by the full name of the parameter
  /// ("rig.load_kg"). A run may lack some of them, for example constants of a force law that was not chosen. The default: none.
  virtual std::map<std::string, double> parameterTolerances() const { return {}; }
  /// Throws BadParameter if one of these names no parameter of the world, a choice, a whole number, or a number that is 0; a robot from a
  /// file throws BadFile with the line.
  virtual void requireTolerances() const;

  const std::vector<Actuator*>& actuators() const { return actuators_; }
  int actuatorCount() const { return static_cast<int>(actuators_.size()); }
  /// Columns of a recording of this robot, without time: command_<i>, pressure_<i>, force_<i>_N, length_<i>_mm, angle_<joint>_deg,
  /// hand_<axis>_mm.
  std::vector<std::string> signalNames() const;
  /// The values of a state in the order of signalNames().
  std::vector<double> signalValues(const State& state) const;
  /// The same backwards.
  void setSignalValues(const std::vector<double>& values, State& state) const;

  /// A joint whose angle is reported.
  struct Angle {
    std::string name;
    Joint* joint;
    int axis;
  };
  const std::vector<Angle>& angles() const { return angles_; }
  /// A body that slides on a guide, by the name of the guide.
  struct Slide {
    std::string name;
    Joint* joint;
  };
  const std::vector<Slide>& slides() const { return slides_; }
  /// Joint::countTurns for all joints whose angles are reported.
  void countTurns(bool from_zero = false) const;
  /// The colours that the robot gave to its muscles; muscles without a name for their colour are left out.
  std::vector<Color> namedMuscleColors() const;
  /// The primitive with the hand or, where none is reported, the load; null if there is neither.
  const Primitive* hand() const { return hand_; }
  /// The hand's point in the world, mm.
  Vector handMm() const;
  /// Adds a point mass at the hand, negative to take one away, before the robot has moved. The reported point stays where it is.
  /// Throws BadParameter as Primitive::addPointMass.
  void loadHand(double mass_g);
  /// Whether the robot built an end of a muscle where mountedStart() or mountedEnd() said.
  bool asksForOffset(int muscle, MuscleEnd end) const { return mounted_ends_.contains({muscle, end}); }
  const std::string& name() const { return name_; }

  void setName(const std::string& name) { name_ = name; }
  /// The file that describes this robot, and a hash of the file's text. Both are empty for robots in C++ and for those that come with the
  /// program.
  const std::string& descriptionFile() const { return description_file_; }
  const std::string& descriptionHash() const { return description_hash_; }
  void setDescription(const std::string& file, const std::string& hash) {
    description_file_ = file;
    description_hash_ = hash;
  }

  /// The robot of the calling thread's current simulation, as in the paper's run loop. Throws BadParameter if there is none.
  static Robot* getActiveRobot();
  /// The simulation says here which robot is the active one of its thread; null: none.
  static void setActiveRobot(Robot* robot);

 protected:
  World& world() const { return world_; }
  dSpaceID space() const { return world_.space(); }
  /// A parameter of this robot; see Parameters::number.
  double parameter(const std::string& name, double default_value, const std::string& unit, double minimum, double maximum,
                   const std::string& description) const;
  // Building by named fields, beside the paper's calls. Everything belongs to the world.
  //     Box& bar = addBox({.mass_g = 400, .size_mm = {200, 20, 20}});
  //     reportAngle("lever", bar.hingeToWorld({.limits_deg = Limits{-40, 40}}));
  //     addMuscle({.from = fixedAt({80, -260, 0}), .to = bar.at({80, -10, 0}), .length_mm = {150, 320}});
  /// These throw BadParameter as the constructors of the primitives do.
  Box& addBox(const BoxOptions& options);
  Sphere& addSphere(const SphereOptions& options);
  CappedCylinder& addCapsule(const CapsuleOptions& options);
  /// A point of the environment.
  static Attachment fixedAt(const Vector& point_mm) { return {nullptr, point_mm}; }
  /// Builds a straight muscle, connects both ends and adds it as the next actuator. Throws BadParameter as Muscle.
  Muscle& addMuscle(const MuscleOptions& options);
  /// The same as addAngle.
  void reportAngle(const std::string& name, Joint& joint, int axis = 0) { addAngle(name, &joint, axis); }
  /// One name of requireTolerances. Constants of a force law that is not the default may be missing.
  void requireTolerance(const std::string& name) const;

  /// Actuators in the order of the action's entries.
  void addActuator(Actuator* actuator);
  /// A joint whose angle is reported as angle_<name>_deg.
  void addAngle(const std::string& name, Joint* joint, int axis = 0);
  /// A slider on which effects may act as slide_<name>. Robots from files list all of theirs.
  void addSlide(const std::string& name, Joint* joint);
  /// The reported point: a point of a primitive's body, given in the body's frame relative to its centre of mass, mm.
  void setHand(Primitive* primitive, const Vector& offset_mm = Vector::Zero());
  /// A point that carries what effects hang on the hand, but is not reported; given as for setHand.
  void setLoad(Primitive* primitive, const Vector& offset_mm = Vector::Zero());
  /// Where the next muscle starts or ends in the pose as built: at the given place, unless an effect displaces it along the direction of
  /// its lever arm or upward.
  Vector mountedStart(const Vector& start_mm, const Vector& lever) { return mounted(MuscleEnd::start, start_mm, lever); }
  Vector mountedEnd(const Vector& end_mm, const Vector& lever) { return mounted(MuscleEnd::end, end_mm, lever); }

 private:
  Vector mounted(MuscleEnd end, const Vector& place_mm, const Vector& lever);

  World& world_;
  std::vector<Actuator*> actuators_;
  std::vector<Angle> angles_;
  std::vector<Slide> slides_;
  std::set<std::pair<int, MuscleEnd>> mounted_ends_;
  Primitive* hand_ = nullptr;
  bool hand_reported_ = false;
  Vector hand_offset_mm_ = Vector::Zero();
  std::string name_ = "robot";
  std::string description_file_, description_hash_;
};

}  // namespace musclesim
