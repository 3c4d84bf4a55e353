/// Controllers decide the command: pressures from the robot's state.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/base/parameters.h"
#include "musclesim/robot/state.h"

namespace musclesim {

class Robot;

/// The arguments from which a controller is built. The controller keeps no reference to them.
struct ControllerRequest {
  Parameters& parameters;                ///< the controller declares its parameters here
  int muscle_count = 0;                  ///< dimension of the action
  double step_s = 0.01;                  ///< time between two calls of output()
  double decision_interval_s = 6.0;      ///< time between two decisions, rounded to whole steps, at least one
  std::uint64_t seed = 1;                ///< seed of the run; each controller derives its own streams
  std::string task = "height";           ///< "height" or "reach"
  std::optional<Vector> target_mm = {};  ///< overrides the task's own target
  const Robot* robot = nullptr;          ///< the robot to be controlled, for controllers that build a model of it; null: not known
  std::string commands_file = {};        ///< table or recording with the commands to play; empty: none
  std::string targets_file = {};         ///< table or recording with the targets to follow; empty: none
  bool interpolate = false;              ///< between two rows of commands: on the straight line, not the earlier row
  std::string channels = {};             ///< muscles and antagonists to move, as channelsFrom reads them; empty: the controller's choice
};

/// A controller is asked once per control step for the pressures of all muscles. It draws and logs nothing.
///
/// A user's controller overrides output() and is registered by name (controller_registry.h):
///     registerController<Mine>("mine", "what it does");
class Controller {
 public:
  virtual ~Controller() = default;

  /// Pressures to command now, one per muscle, each in 0..1. Called once per control step, in order of time.
  virtual Action output(const State& state) = 0;

  /// Activity at the last decision, for the log and the figure; none if the controller has no such notion.
  virtual std::optional<double> activity() const { return std::nullopt; }
  /// Target of the hand in mm, for the log, the figure and the window; none if there is no target.
  virtual std::optional<Vector> targetMm() const { return std::nullopt; }
  /// True when only the height (y) of the target counts.
  virtual bool targetIsHeight() const { return false; }
  /// Moves the target from the next output() on; of a height only y counts. Without effect where there is no target.
  virtual void moveTarget(const Vector& target_mm) { static_cast<void>(target_mm); }
  /// Further columns of the log, target_<joint>_deg or controller_<name>, with their values at the last output(); names and order never
  /// change.
  virtual std::vector<std::pair<std::string, double>> signals() const { return {}; }
  /// Time at which the commands end, s: the default duration of a run; none if there is no such time.
  virtual std::optional<double> endS() const { return std::nullopt; }
  /// What a user should know before the run, one sentence each: what the controller has chosen or noticed.
  virtual std::vector<std::string> notes() const { return {}; }

  /// The controller of the calling thread's current simulation, as in the paper's run loop. Throws BadParameter if there is none.
  static Controller* getActiveController();
  /// The simulation says here which controller is the active one of its thread; null: none.
  static void setActiveController(Controller* controller);
};

}  // namespace musclesim
