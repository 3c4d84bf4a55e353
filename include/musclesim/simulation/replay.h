/// Replays a recording's commands through the model and compares the simulated readings with the recorded ones.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

/// Options of a replay. Where one is given, it replaces the sidecar's entry.
struct ReplayOptions {
  std::optional<std::string> robot, initial_state;
  std::optional<PhysicsKind> physics;
  std::optional<double> step_s;
  StepperKind stepper = StepperKind::automatic;
  int substeps = 0;
  bool plane = false;
  std::optional<std::uint64_t> seed;
  Parameters parameters;              ///< replace entries of the sidecar's robot_parameters
  std::vector<ActiveEffect> effects;  ///< added to the sidecar's active_effects; for held_effect see replayRecording
  /// Called with the simulation before the first row. The function it returns is called with the readings of every row.
  using Watcher = std::function<void(const State&)>;
  std::function<Watcher(Simulation&)> watch;
  std::function<bool()> interrupted;  ///< polled during the replay; returning true ends it soon
  int most_substeps = 0;              ///< a robot that needs more internal steps per control step is refused; 0: none is
  bool body_moves = true;             ///< false: only commands and pressures are right (SimulationOptions::body_moves)
};

/// Error of one signal, simulated minus recorded, over the samples where both are numbers.
struct SignalError {
  std::string name;
  double rmse = 0, largest = 0;
  long sample_count = 0;
};

struct ReplayResult {
  Recording simulated;              ///< at the recording's times; shorter and marked incomplete if the replay diverged or was interrupted
  std::vector<SignalError> errors;  ///< one per signal that both recordings have, except commands
  JointGap worst_gap;
  int substeps = 1;
  std::string stepper;
  std::optional<std::string> divergence;  ///< the error message, if the replay diverged
  bool interrupted = false;
};

/// Describes a model for a sidecar, so that simulationOptionsFor can build it again: robot, physics, initial state, all parameters of the
/// robot, other parameters that differ from their defaults, ground plane, effects, noise, seed and step. Further members hold the stepper,
/// its internal steps and all named parameters.
RecordingInfo describeModel(Simulation& simulation, const std::string& initial_state);

/// A remark on each signal of a recording that the robot does not have, so that it is not compared; with the name that may be meant.
std::vector<std::string> unknownSignalNotes(const Recording& recording, const Robot& robot);

/// A remark for the user if the robot's file is no longer the one with which the recording was made; otherwise empty.
std::string otherDescriptionNote(const RecordingInfo& info, const Robot& robot);

/// Replaces the recording's robot by `robot`, if given, and removes the parameters of the recording's robot.
void replaceRobot(RecordingInfo& info, const std::optional<std::string>& robot);

/// Options for a simulation of the recording's plant: physics, step, parameters of the robot. Throws BadFile if the recording's robot is
/// not registered and `options` names no robot.
SimulationOptions simulationOptionsFor(const RecordingInfo& info, const std::string& source, const ReplayOptions& options = {});

/// The effect that loses samples. A model cannot predict which samples are lost, but the recording shows it.
inline constexpr const char* held_effect = "sensor_dropout";

/// Repeats the previous predicted value in every row in which the measured value repeats the previous one. predicted, measured: [rows]
void holdWhereMeasured(std::vector<double>& predicted, const std::vector<double>& measured);

/// Simulates the plant of a recording under its commands, each held until the next row, with the recording's active effects and those of
/// the options; the simulated recording names both. If the options contain held_effect, it loses the samples that the recording lost; in
/// signals that the recording does not have, lost samples are drawn at random. Each call builds its own simulation, so calls may run in
/// parallel threads. Throws BadFile if the robot is not registered or its number of muscles differs from the recording's number of
/// commands, BadParameter for parameters that the model does not know, and for a robot that needs more than most_substeps.
ReplayResult replayRecording(const Recording& recording, const ReplayOptions& options = {});

/// Error of every signal of `simulated` that `measured` also has, row by row; commands are not compared.
std::vector<SignalError> compareSignals(const Recording& simulated, const Recording& measured);

}  // namespace musclesim
