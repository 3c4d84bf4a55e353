/// What a clean model leaves out: effects along the way of a sample, command -> pressure -> force -> body -> sensor.
///
/// A class stands for one physical cause on one component (one muscle, joint, signal, ...); for "all" there is one object per component.
/// Its state is part of the simulation that owns it. A user's own effect derives from the class of its stage and is registered with
/// registerEffect (musclesim/effect/catalogue.h).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "musclesim/robot/joint.h"
#include "musclesim/robot/state.h"

namespace musclesim {

class Actuator;
class Primitive;
class Robot;
class LengthRate;
class World;

enum class Stage { command, pressure, force, body, sensor };
std::string nameOf(Stage stage);

/// What one object of an effect acts on.
enum class ComponentKind { muscle, muscle_pair, all_muscles, joint, slide, hand, base, signal };

/// One number of an effect, for users and for fits.
struct EffectParameter {
  std::string name;  ///< ends in its unit
  std::string unit;
  double neutral;                ///< changes nothing; of a shape parameter: what holds where none is given
  double minimum, maximum;       ///< what is accepted
  double usual_low, usual_high;  ///< where real plants lie; where fits begin
  std::string meaning;
  bool shape = false;                     ///< says how the effect acts, not how strongly: alone it changes nothing
  std::vector<std::string> choices = {};  ///< words in place of numbers; the value is the index of the word
  bool adds_mechanism = false;            ///< a further mechanism in series with the effect's own (further lags)
};

/// Values of all parameters of one effect, in the order of its list.
class EffectValues {
 public:
  /// Throws std::logic_error unless there is one value for each parameter.
  EffectValues(const std::vector<EffectParameter>& parameters, std::vector<double> values);
  /// Throws std::logic_error for a name that is not in the list.
  double operator[](const std::string& name) const;
  const std::vector<double>& all() const { return values_; }

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
};

/// When an effect is asked.
struct StepTime {
  double clock_s = 0;  ///< since the start of the run; negative while it settles
  double h_s = 0;      ///< length of the step that begins now; 0: a look at the present, nothing moves on
};

/// Where one object of an effect acts. References and pointers are valid as long as the simulation.
struct EffectPlace {
  World& world;
  Robot& robot;
  ComponentKind kind;
  int muscle, other_muscle;                 ///< numbers in the robot's order; -1: none
  std::string joint;                        ///< name in angle_<joint>_deg, or of the guide of a slide
  int signal;                               ///< number in Robot::signalNames(); -1: none
  std::string component;                    ///< of this place, for messages
  bool one_of_all;                          ///< the effect was asked for on "all"
  const LengthRate* length_rate = nullptr;  ///< of the muscle; null where there is none
};

class Effect {
 public:
  virtual ~Effect() = default;
  Effect() = default;
  Effect(const Effect&) = delete;
  Effect& operator=(const Effect&) = delete;

  /// Called once, when the robot has been built and stands as built. Throws BadParameter if the effect cannot act there.
  virtual void attach(const EffectPlace&) {}
  /// Forgets the past: the state before the first step.
  virtual void reset() {}
};

/// Command and pressure stage: changes fractions of full scale, one per muscle in the robot's order.
class RatioEffect : public Effect {
 public:
  /// From what comes in at time.clock_s and is held for time.h_s to what goes out at the end of that time.
  virtual void apply(std::vector<double>& ratios, const StepTime& time) = 0;
  /// The same as if what comes in had been there for ever. Called after reset().
  virtual void settle(std::vector<double>& ratios) = 0;
};

/// A RatioEffect on one muscle.
class MuscleRatioEffect : public RatioEffect {
 public:
  void attach(const EffectPlace& place) override;
  void apply(std::vector<double>& ratios, const StepTime& time) final;
  void settle(std::vector<double>& ratios) final;

 protected:
  virtual double output(double input, const StepTime& time) = 0;
  virtual double settled(double input) = 0;
  const Actuator& actuator() const { return *actuator_; }
  /// Rate of the muscle's length at present, mm/s.
  double lengthRateMmPerS() const;

 private:
  const Actuator* actuator_ = nullptr;
  const LengthRate* length_rate_ = nullptr;
  std::size_t muscle_ = 0;
};

/// What the tension of a muscle depends on.
struct MuscleInput {
  double pressure_ratio = 0;
  double length_mm = 0;
  double rate_mm_per_s = 0;  ///< of the length; positive: it gets longer
  StepTime time;
};

class ForceStack;

/// The tension without the effect that asks: the force law with all effects further inside.
class ForceBelow {
 public:
  ForceBelow(ForceStack& stack, std::size_t level) : stack_(stack), level_(level) {}
  double operator()(const MuscleInput& input) const;

 private:
  ForceStack& stack_;
  std::size_t level_;
};

/// Force stage of one muscle. Effects enclose each other, the force law innermost; each may change what goes in and what comes out.
class ForceEffect : public Effect {
 public:
  void attach(const EffectPlace& place) override;
  /// Tension in N, pulling positive. May be asked several times for the same moment and must not move the state on. The last call of
  /// `below` must be the one whose answer is used.
  virtual double tensionN(const MuscleInput& input, const ForceBelow& below) const = 0;
  /// Moves the state on by input.time.h_s; `input` is that of the last tensionN.
  virtual void advance(const MuscleInput&) {}
  /// The state when everything has been as in `input` for ever.
  virtual void settle(const MuscleInput&) { reset(); }

 protected:
  const Actuator& actuator() const { return *actuator_; }
  World& world() const { return *world_; }

 private:
  World* world_ = nullptr;
  const Actuator* actuator_ = nullptr;
};

/// Body stage: loads on bodies at each internal step, or changes of the bodies when it is attached.
class BodyEffect : public Effect {
 public:
  /// Adds forces and torques to the bodies as they are now. Friction aside, it is also asked for robots at rest to find their equilibrium.
  virtual void apply(const StepTime&) {}
};

/// A BodyEffect on one hinge.
class JointEffect : public BodyEffect {
 public:
  /// Throws BadParameter for a joint that is not a hinge.
  void attach(const EffectPlace& place) override;

 protected:
  double angleDeg() const;
  double rateRadPerS() const;
  void addTorqueNm(double torque_Nm) const;
  /// Once, when it is attached: dry friction beside what the joint has.
  void addDryFrictionNm(double torque_Nm) const;
  const Joint& joint() const { return *joint_; }

 private:
  Joint* joint_ = nullptr;
  double force_per_N_ = 0;
};

/// A BodyEffect on a body that slides on a guide (Robot::slides).
class SlideEffect : public BodyEffect {
 public:
  void attach(const EffectPlace& place) override;

 protected:
  double rateMmPerS() const;
  void addForceN(double force_N) const;
  /// Once, when it is attached: dry friction beside what the guide has.
  void addDryFrictionN(double force_N) const;

 private:
  Joint* joint_ = nullptr;
  double force_per_N_ = 0;
};

/// A BodyEffect at the hand, the point that the robot reports or carries its load at.
class HandEffect : public BodyEffect {
 public:
  void attach(const EffectPlace& place) override;

 protected:
  Vector pointMm() const;
  void addForceN(const Vector& force_N) const;
  Robot& robot() const { return *robot_; }

 private:
  Robot* robot_ = nullptr;
  double force_per_N_ = 0;
};

/// Sensor stage of one signal: the motion is right, the reading is not.
class SensorEffect : public Effect {
 public:
  /// The reading for what comes in at time.clock_s. `sample` counts the times at which the robot has been read. May be asked several
  /// times for one sample, with what comes in changed.
  virtual double reading(double value, const StepTime& time, long sample) = 0;
  /// What comes in, told at every internal step if tracks().
  virtual void track(double, const StepTime&) {}
  virtual bool tracks() const { return false; }
  /// Whether the reading depends on the sample; such effects act after all others.
  virtual bool perSample() const { return false; }
};

}  // namespace musclesim
