/// The effects of one simulation, in the order in which a sample meets them.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "musclesim/effect/effect.h"
#include "musclesim/log/active_effect.h"
#include "musclesim/robot/actuator.h"

namespace musclesim {

class ForceStack;
class SensorStage;

/// Force and torque about the centre of mass.
struct BodyLoad {
  Vector force_N = Vector::Zero(), torque_Nmm = Vector::Zero();
};

/// Owns the effects' objects and calls them, stage by stage; effects whose parameters are neutral are left out. Within a stage they act in
/// the catalogue's order, whatever the order in which they were given.
class EffectChain {
 public:
  /// Throws BadParameter for an unknown id or wrong parameters. Components are checked by attach().
  EffectChain(Simulation& simulation, std::vector<ActiveEffect> effects);
  ~EffectChain();

  /// The effects as they were given.
  const std::vector<ActiveEffect>& active() const { return given_; }
  /// Makes the objects and lets them change the robot, which has just been built. Throws BadParameter for a component that the robot
  /// does not have.
  void attach();

  // The stages of one internal step of h_s seconds, in this order. With h_s = 0 nothing moves on.
  void command(double h_s);   ///< what reaches the valves
  void pressure(double h_s);  ///< pressures in the muscles
  void force(double h_s);     ///< tensions
  void body(double h_s);      ///< loads on the bodies
  void track(double h_s);     ///< what sensors must remember; then the clock moves on
  /// Sensor stage: from the true state to the readings.
  void read(State& state);

  // How a run begins.
  /// Forgets the past and sets the pressures as if the command had been held for ever.
  void settlePressures(const Action& command);
  /// Tension of a muscle that has been held at a length and the present pressure for ever.
  double restingTensionN(int muscle, double length_mm);
  /// Loads of the body stage on a robot at rest, on the body of a primitive.
  BodyLoad restingLoad(const Primitive& primitive);
  /// The muscles have been at their present lengths for ever, and it is clock_s.
  void begin(double clock_s);

  /// Standard deviations of the sensors' noise by signal, where there is any.
  const std::map<std::string, double>& noise() const;
  /// Rate of a muscle's length over the last internal step, mm/s.
  double lengthRateMmPerS(std::size_t muscle) const;
  /// Whether an effect of that id acts on anything.
  bool has(const std::string& id) const;
  /// How far beside its place an end of a muscle is, mm; `lever`: unit vector along its lever arm.
  Vector mountOffsetMm(int muscle, MuscleEnd end, const Vector& lever) const;

 private:
  struct Muscle;
  struct Planned;
  void requireMuscles();
  void addObject(const Planned& planned, const EffectPlace& place);
  MuscleInput inputOf(const Muscle& muscle, double h_s) const;

  Simulation& simulation_;
  std::vector<ActiveEffect> given_;
  std::vector<Planned> planned_;  ///< those that are not neutral, in order
  bool attached_ = false;
  double clock_s_ = 0;
  std::vector<Muscle> muscles_;  ///< the robot's, then all others
  std::vector<double> ratios_;
  std::vector<std::unique_ptr<RatioEffect>> command_, pressure_;
  std::vector<std::unique_ptr<BodyEffect>> body_;
  std::unique_ptr<SensorStage> sensors_;
};

}  // namespace musclesim
