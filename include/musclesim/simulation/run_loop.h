/// The paper's run loop: state, output, step. The program's runs, those of Python and of programs of one's own go through it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/controller/controller.h"
#include "musclesim/robot/physics.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

/// Default time between two decisions of a controller, s: the paper's 6 s in original physics; in true seconds the time that the arm takes
/// to settle (docs/reference/parameters.md).
double defaultDecisionIntervalS(const PhysicsSettings& physics);

/// Name of the controller of a run that names none: the paper's for its arm, and where there is a task; for other robots a slow triangle of
/// their antagonists, or of all muscles, which every robot can follow.
std::string defaultController(const Robot& robot, bool has_task);
/// Simulated time of a run that gives none, s: to the end of the controller's commands, if they have one; else the published 300 s.
double defaultDurationS(const Controller& controller);

/// What a controller for the simulation's robot is built from. Throws BadParameter unless the decision interval is positive and finite.
ControllerRequest controllerRequest(Simulation& simulation, const std::string& task, const std::optional<double>& decision_interval_s);

/// Columns of the recording of a run, without time: the robot's signals, then target, activity and further signals if the controller
/// reports them. Throws BadParameter if the controller's further signals have names that a recording cannot have.
std::vector<std::string> runColumns(const Robot& robot, const Controller& controller);
/// The values of one row, in the order of runColumns.
std::vector<double> runRow(const Robot& robot, const Controller& controller, const State& state);

struct RunLoop {
  double duration_s = 300;                             ///< simulated time, rounded to whole control steps
  std::optional<double> record_interval_s = {};        ///< time between two rows, rounded to whole control steps; none: every step
  std::function<void(const State&, bool is_due)> row;  ///< the readings just after each command began to act; due: a row to record
  std::function<bool()> goes_on = nullptr;             ///< asked before every control step; false ends the run
  std::function<void()> after_step = nullptr;          ///< called after every control step
  std::function<void(double interval_s)> command_is_late = nullptr;  ///< a command changed between two rows, which are interval_s apart

  /// Throws BadParameter unless the duration is at least one control step of step_s and at most 1e7 s, and the interval positive and
  /// finite.
  void requireTimes(double step_s) const;
};

/// Runs the simulation's robot under a controller, from a start with `first_command` (Simulation::start) to the duration or until
/// `goes_on` is false. The last row is always due. Passes on what the controller, the step and the callbacks throw.
void runLoop(Simulation& simulation, Controller& controller, Action first_command, const RunLoop& loop);

}  // namespace musclesim
