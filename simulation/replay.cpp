#include "musclesim/simulation/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "musclesim/controller/replay.h"
#include "musclesim/error.h"
#include "musclesim/version.h"

namespace musclesim {

namespace {

constexpr double default_step_s = 0.01;

void appendRow(Recording& recording, double time_s, const std::vector<double>& values) {
  recording.time_s.push_back(time_s);
  for (std::size_t i = 0; i < values.size(); ++i) recording.signals[i].values.push_back(values[i]);
}

/// The number of internal steps that a run of this program noted in its sidecar; 0 if there is none.
int recordedSubsteps(const RecordingInfo& info) {
  const auto extra = nlohmann::json::parse(info.extra_json, nullptr, false);
  if (!extra.is_object() || !extra.contains("substeps") || !extra["substeps"].is_number_integer()) return 0;
  return extra["substeps"].get<int>();
}

void requireRegistered(const std::string& robot, const std::string& source) {
  std::vector<std::string> names;
  for (const auto& [name, description] : Robot::registered()) names.push_back(name);
  if (std::ranges::find(names, robot) == names.end())
    throw BadFile(source, fmt::format("there is no robot \"{}\"; registered: {}", robot, fmt::join(names, ", ")));
}

}  // namespace

SimulationOptions simulationOptionsFor(const RecordingInfo& info, const std::string& source, const ReplayOptions& options) {
  if (!options.robot) requireRegistered(info.robot, source);
  SimulationOptions result;
  result.physics = options.physics ? *options.physics : physicsFromName(info.physics.value_or("si"));
  result.step_s = options.step_s.value_or(info.step_s.value_or(default_step_s));
  result.stepper = options.stepper;
  result.substeps = options.substeps;
  // A run of ours is repeated with its own internal steps unless the user changes what they depend on.
  if (options.substeps == 0 && !options.physics && !options.step_s) result.substeps = recordedSubsteps(info);
  result.plane = options.plane;
  result.seed = options.seed;
  for (const auto& [name, value] : info.robot_parameters)
    result.parameters.set(name.find('.') == std::string::npos ? info.robot + "." + name : name, value, source);
  result.parameters.setAll(options.parameters);
  result.effects = info.active_effects;
  result.effects.insert(result.effects.end(), options.effects.begin(), options.effects.end());
  return result;
}

ReplayResult replayRecording(const Recording& recording, const ReplayOptions& options) {
  RecordingInfo info = recording.info;
  if (options.robot) info.robot = *options.robot;
  Simulation simulation(simulationOptionsFor(info, sidecarPath(recording.file), options));
  Robot& robot = simulation.build(info.robot);
  simulation.parameters().requireAllKnown();
  ReplayController commands(recording, robot.actuatorCount());

  ReplayResult result;
  result.substeps = simulation.substeps();
  result.stepper = simulation.stepper().name();
  result.simulated.info = info;
  result.simulated.info.physics = nameOf(simulation.physics().kind);
  result.simulated.info.initial_state = options.initial_state.value_or(info.initial_state.value_or(robot.initialState()));
  result.simulated.info.step_s = simulation.stepS();
  result.simulated.info.program = "musclesim " MUSCLESIM_VERSION;
  result.simulated.info.noise_std = simulation.effects().noise();
  result.simulated.info.active_effects = simulation.effects().active();
  const ReplayOptions::Watcher watcher = options.watch ? options.watch(simulation) : nullptr;
  for (const auto& name : robot.signalNames()) result.simulated.signals.push_back({name, {}});
  try {
    for (std::size_t row = 0; row < recording.time_s.size(); ++row) {
      State state = robot.getState();
      state.time_s = recording.time_s[row];
      const Action action = commands.output(state);
      if (row == 0)
        simulation.start(*result.simulated.info.initial_state, action);
      else
        robot.step(action);
      State reading = robot.getState();
      reading.time_s = recording.time_s[row];
      appendRow(result.simulated, recording.time_s[row], robot.signalValues(reading));
      if (watcher) watcher(reading);
      if (row + 1 < recording.time_s.size()) simulation.advance(recording.time_s[row + 1] - recording.time_s[row]);
    }
  } catch (const Diverged& error) {
    result.divergence = error.what();
  }
  result.worst_gap = simulation.worstGap();
  result.errors = compareSignals(result.simulated, recording);
  return result;
}

std::vector<SignalError> compareSignals(const Recording& simulated, const Recording& measured) {
  std::vector<SignalError> errors;
  for (const Signal& signal : simulated.signals) {
    const Signal* other = measured.find(signal.name);
    if (!other || signal.name.starts_with("command_")) continue;
    SignalError error{signal.name, 0, 0, 0};
    double sum_of_squares = 0;
    for (std::size_t row = 0; row < std::min(signal.values.size(), other->values.size()); ++row) {
      const double difference = signal.values[row] - other->values[row];
      if (!std::isfinite(difference)) continue;
      sum_of_squares += difference * difference;
      error.largest = std::max(error.largest, std::abs(difference));
      ++error.sample_count;
    }
    if (error.sample_count > 0) error.rmse = std::sqrt(sum_of_squares / static_cast<double>(error.sample_count));
    errors.push_back(error);
  }
  return errors;
}

}  // namespace musclesim
