/// The effects of one simulation, in the order in which a sample meets them.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "musclesim/effect/effect.h"
#include "musclesim/log/active_effect.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/robot_effects.h"

namespace musclesim {

class ForceStack;
class MuscleAir;
class SensorStage;

/// Owns the effects' objects and calls them, stage by stage; effects whose parameters are neutral are left out. Within a stage they act in
/// the catalogue's order, whatever the order in which they were given.
class EffectChain final : public RobotEffects {
 public:
  /// Throws BadParameter for an unknown id or wrong parameters. Components are checked by attach().
  EffectChain(World& world, std::vector<ActiveEffect> effects);
  ~EffectChain() override;

  /// The effects as they were given.
  const std::vector<ActiveEffect>& active() const { return given_; }
  /// Makes the objects and lets them change the robot, which has just been built. Throws BadParameter for a component that the robot
  /// does not have.
  void attach(Robot& robot);

  // The stages of one internal step of h_s seconds, in this order. With h_s = 0 no state moves on. The clock is the world's; it moves on
  // after track().
  /// Commands on their way to the valves: values.pressure_ratio is what reaches them.
  void command(MuscleValues& values, double h_s);
  /// values.pressure_ratio becomes the pressure in the muscles.
  void pressure(MuscleValues& values, double h_s);
  /// values.tension_N follows from the pressures and the present lengths.
  void force(MuscleValues& values, double h_s);
  /// Loads on the bodies.
  void body(double h_s);
  /// Tells the sensors that remember what the signals are at the beginning of the step.
  void track(double h_s);

  // What robots ask for.
  Vector mountOffsetMm(int muscle, MuscleEnd end, const Vector& lever) const override;
  void update() override;
  void read(State& state) override;
  double restingTensionN(int muscle, double length_mm) override;
  /// As if the body did not move.
  BodyLoad restingLoad(const Primitive& primitive) override;

  // How a run begins.
  /// Forgets the past and sets commands and pressures as if the command had been held for ever.
  void settlePressures(const Action& command);
  /// The muscles have been at their present lengths for ever.
  void begin();

  /// Standard deviations of the sensors' noise by signal, where there is any.
  const std::map<std::string, double>& noise() const;
  /// Whether an effect of that id acts on anything.
  bool has(const std::string& id) const;

 private:
  struct Muscle;
  struct Planned;
  void requireMuscles();
  void addObject(const Planned& planned, EffectPlace place);
  static void joinBalance(Muscle& muscle, MuscleAir* effect);
  MuscleInput inputOf(std::size_t muscle, double pressure_ratio, double h_s) const;
  StepTime at(double h_s) const { return {world_.clock().now_s(), h_s}; }

  World& world_;
  Robot* robot_ = nullptr;  ///< null until attach()
  std::vector<ActiveEffect> given_;
  std::vector<Planned> planned_;                  ///< the effects that are not neutral, in order
  std::vector<std::unique_ptr<Muscle>> muscles_;  ///< in the order of World::actuators()
  std::vector<std::unique_ptr<RatioEffect>> command_, pressure_;
  std::vector<std::unique_ptr<BodyEffect>> body_;
  std::unique_ptr<SensorStage> sensors_;
};

}  // namespace musclesim
