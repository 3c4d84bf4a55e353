/// Plays a recording's commands through the model and compares what the model measures with what was recorded.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

/// What replaces the sidecar's word where it is given.
struct ReplayOptions {
  std::optional<std::string> robot, initial_state;
  std::optional<PhysicsKind> physics;
  std::optional<double> step_s;
  StepperKind stepper = StepperKind::automatic;
  int substeps = 0;
  bool plane = false;
  std::optional<std::uint64_t> seed;
  Parameters parameters;              ///< wins over the sidecar's robot_parameters
  std::vector<ActiveEffect> effects;  ///< besides the sidecar's active_effects; held_effect as replayRecording says
  /// Called before the first row with the simulation; what it returns is shown the readings of every row.
  using Watcher = std::function<void(const State&)>;
  std::function<Watcher(Simulation&)> watch;
  std::function<bool()> interrupted;  ///< true ends the replay soon
};

/// Difference of one signal, simulated minus recorded, over the samples where both are numbers.
struct SignalError {
  std::string name;
  double rmse = 0, largest = 0;
  long sample_count = 0;
};

struct ReplayResult {
  Recording simulated;              ///< at the recording's times; shorter, and not complete, if it diverged or was interrupted
  std::vector<SignalError> errors;  ///< of every signal that both have, commands excepted
  JointGap worst_gap;
  int substeps = 1;
  std::string stepper;
  std::optional<std::string> divergence;  ///< the message, if it diverged
  bool interrupted = false;
};

/// What a sidecar states of a model, so that simulationOptionsFor builds it again: robot, physics, initial state, parameters that differ
/// from their defaults (the robot's own: all), ground plane, effects, noise, seed and step; as further members the stepper, its internal
/// steps and all named parameters.
RecordingInfo describeModel(Simulation& simulation, const std::string& initial_state);

/// Signals of a recording that a robot with these does not report: nothing is compared with them.
std::vector<std::string> unknownSignals(const Recording& recording, const std::vector<std::string>& of_robot);

/// Another robot in place of the recording's, if one is given: parameters of the recording's own robot are left out.
void replaceRobot(RecordingInfo& info, const std::optional<std::string>& robot);

/// Options for a simulation of the recording's plant: physics, step, parameters of the robot. Throws BadFile if the recording names a robot
/// that is not registered and the options none.
SimulationOptions simulationOptionsFor(const RecordingInfo& info, const std::string& source, const ReplayOptions& options = {});

/// Which samples were lost is chance that no model predicts, but the recording shows it.
inline constexpr const char* held_effect = "sensor_dropout";

/// Where a measured value is the one of the row before, so becomes the predicted one. predicted, measured: [rows]
void holdWhereMeasured(std::vector<double>& predicted, const std::vector<double>& measured);

/// Simulates the plant of a recording under its commands, each held until the next row, with its active effects and those of the options.
/// The simulated recording names both as its active effects. Samples that a held_effect of the options loses in a signal that the recording
/// has are those that the recording lost; otherwise they are drawn. Each call builds a simulation of its own, so that any number can run in
/// as many threads. Throws BadFile if the robot is not registered or has another number of muscles than the recording has commands,
/// BadParameter for parameters unknown to the model.
ReplayResult replayRecording(const Recording& recording, const ReplayOptions& options = {});

/// Error of every signal of `simulated` that `measured` also has, row by row; commands are not compared.
std::vector<SignalError> compareSignals(const Recording& simulated, const Recording& measured);

}  // namespace musclesim
