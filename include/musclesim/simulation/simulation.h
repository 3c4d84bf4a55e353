/// A simulation: a world with a robot in it, moved step by step.
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/error.h"
#include "musclesim/base/parameters.h"
#include "musclesim/controller/controller.h"
#include "musclesim/effect/effect_chain.h"
#include "musclesim/log/active_effect.h"
#include "musclesim/robot/pull.h"
#include "musclesim/robot/robot.h"
#include "musclesim/robot/world.h"
#include "musclesim/simulation/stepper.h"

namespace musclesim {

class Contacts;

struct SimulationOptions {
  PhysicsKind physics = PhysicsKind::si;
  StepperKind stepper = StepperKind::automatic;
  double step_s = 0.01;  ///< control and logging step
  int substeps = 0;      ///< internal steps per control step; 0: as many as the muscles need
  bool plane = false;    ///< a ground plane at the height of the parameter "world.plane_height_mm"
  std::uint64_t seed = 1;
  Parameters parameters;              ///< overrides by name
  std::vector<ActiveEffect> effects;  ///< what the clean model leaves out
  std::function<bool()> interrupted;  ///< asked before every internal step; true ends the step in Interrupted
  /// False: the bodies stay where they are built, and only commands, pressures and what sensors make of them go on. The pressures are
  /// those of a moving body, to the bit, if all effects of the command and pressure stages ignore motion (EffectInfo::ignores_motion).
  bool body_moves = true;
};

/// The largest distance by which a joint is torn.
struct JointGap {
  double gap_mm = 0;
  std::string joint;
};

/// An ordinary object: many can live in one process and in different threads, each used by one thread at a time.
///
/// It owns the world with everything built in it, the effects, the robot and the controller, and calls the stages of a step in the order in
/// which a sample meets them: command, pressure, force, body, sensor. Time is counted in control steps.
/// A run that leaves the numbers a physical system can have ends in Diverged: nothing is reset.
class Simulation {
 public:
  /// Throws BadParameter for a step or a number of internal steps that cannot be.
  explicit Simulation(SimulationOptions options = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Builds a registered robot in this simulation's world. Throws BadParameter if it already has one.
  Robot& build(const std::string& robot_name);
  /// Builds the robot that a function makes, for example makeRobotFromText.
  Robot& build(const std::function<std::unique_ptr<Robot>(World&)>& make) { return adopt(make(*world_)); }
  /// Builds a robot of a class that need not be registered.
  template <class RobotType>
  RobotType& build() {
    return static_cast<RobotType&>(adopt(std::make_unique<RobotType>(*world_)));
  }
  Controller& control(std::unique_ptr<Controller> controller);

  /// Puts the robot into its initial state for the first command and sets the time to 0.
  /// "built": the pose as built, at rest. "settled": at rest at the frictionless equilibrium for the command, then 0.5 s with the command
  /// held; effects are part of the equilibrium. Throws BadParameter for another name or a robot that cannot settle.
  void start(const std::string& initial_state, const Action& first_command);

  /// Puts the robot at rest at its frictionless equilibrium, as if the command and its effects had acted for ever. Throws BadParameter for
  /// a robot that cannot settle.
  void settle(const Action& command);
  /// One control step: pressures, forces, then the bodies, in substeps() internal steps.
  /// Throws Diverged with time, place and cause; the world is then frozen as it was, and further steps throw the same again. Throws
  /// Interrupted within the step if the options ask for it; the time is then still that of the step's beginning.
  void step();
  /// The same for any duration, in equal internal steps no longer than those of step(). Throws BadParameter unless it is positive.
  void advance(double duration_s);

  double time_s() const { return world_->clock().time_s(); }
  long stepCount() const { return world_->clock().stepCount(); }
  double stepS() const { return world_->clock().stepS(); }
  /// Internal steps per control step; if they were not given, they follow from the muscles once the robot is built.
  int substeps() const { return substeps_; }
  double internalStepS() const { return stepS() / substeps_; }
  std::uint64_t seed() const { return world_->seed(); }
  const PhysicsSettings& physics() const { return world_->physics(); }
  const Stepper& stepper() const { return *stepper_; }
  Parameters& parameters() { return world_->parameters(); }

  /// Where robots are built. It stands for its ODE world wherever one is expected.
  World& world() { return *world_; }
  const World& world() const { return *world_; }
  dSpaceID space() const { return world_->space(); }
  Robot& robot();
  EffectChain& effects() { return *effects_; }
  Controller* controller() { return controller_.get(); }

  /// Pulls at a body from now on; none: nobody pulls. Throws BadParameter if there is no such body.
  void pull(const std::optional<Pull>& pull);
  const std::optional<Pull>& pull() const { return pull_; }

  int contactCount() const;
  /// The contacts of the last internal step.
  const Contacts& contacts() const { return *contacts_; }
  /// Number of messages from ODE's solver ("LCP internal error") during this simulation's steps.
  long solverMessageCount() const { return solver_message_count_; }

  /// The joint that is torn furthest at present.
  JointGap largestGap() const { return named(tornMost()); }
  /// The largest gap seen at the end of any control step so far.
  JointGap worstGap() const { return named(worst_gap_); }
  /// Sum of kinetic energy and of potential energy against y = 0, in J (true seconds only in `si` and `scaled`).
  double mechanicalEnergyJ() const;
  /// Sets all velocities to 0.
  void stop();

  /// The calling thread's current simulation: the last one that was constructed or made current. Throws BadParameter if there is none.
  static Simulation& current();
  void makeCurrent();
  /// The paper's run loop: steps the calling thread's current simulation.
  static void doStep() { current().step(); }

 private:
  Robot& adopt(std::unique_ptr<Robot> robot);
  void prepareSteps();
  template <class Function>
  void untilDiverged(const Function& move);
  void internalStep(double h_s);
  void pushBodies() const;
  void collide(double h_s);
  void requireFinite() const;
  BodyBounds bodyBounds() const;
  void requireWhole();
  TornJoint tornMost() const;
  static JointGap named(const TornJoint& torn);
  std::string labelOf(dBodyID id) const;

  std::unique_ptr<World> world_;
  int substeps_ = 1;
  bool substeps_given_ = false;
  std::size_t prepared_actuator_count_ = 0;
  bool faulted_ = false;
  std::optional<Diverged> divergence_;
  std::function<bool()> interrupted_;
  bool body_moves_;
  long solver_message_count_ = 0;
  TornJoint worst_gap_;
  std::optional<Pull> pull_;
  std::unique_ptr<Contacts> contacts_;
  std::unique_ptr<Stepper> stepper_;
  std::unique_ptr<EffectChain> effects_;
  std::unique_ptr<Robot> robot_;
  std::unique_ptr<Controller> controller_;
};

}  // namespace musclesim
