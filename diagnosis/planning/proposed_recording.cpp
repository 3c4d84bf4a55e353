#include "musclesim/diagnosis/proposed_recording.h"

#include <fmt/format.h>

namespace musclesim {

namespace {

std::string scheduleText(const Experiment& experiment) {
  std::string text = "time_s";
  for (std::size_t i = 0; i < experiment.commands.front().size(); ++i) text += fmt::format(",command_{}", i);
  text += "\n";
  for (std::size_t row = 0; row < experiment.time_s.size(); ++row) {
    text += fmt::format("{:.3f}", experiment.time_s[row]);
    for (const double value : experiment.commands[row]) text += fmt::format(",{:.4f}", value);
    text += "\n";
  }
  return text;
}

}  // namespace

RecordingInfo diagnosedModel(const Recording& recording, const ReplayOptions& model) {
  RecordingInfo given = recording.info;
  replaceRobot(given, model.robot);
  Simulation simulation(simulationOptionsFor(given, sidecarPath(recording.file), model));
  const Robot& robot = simulation.build(given.robot);
  RecordingInfo described = describeModel(simulation, model.initial_state.value_or(given.initial_state.value_or(robot.initialState())));
  described.active_effects = given.active_effects;
  return described;
}

ProposedRecording proposedRecording(const Diagnosis& diagnosis, const RecordingInfo& model, const std::string& sidecar) {
  if (diagnosis.next_experiment.commands.empty()) return {};
  RecordingInfo info;
  info.robot = model.robot;
  info.robot_hash = model.robot_hash;
  info.physics = model.physics;
  info.initial_state = model.initial_state;
  info.robot_parameters = model.robot_parameters;
  info.active_effects = model.active_effects;
  info.description = "commands proposed by a diagnosis";
  return {scheduleText(diagnosis.next_experiment), sidecarText(info, sidecar)};
}

}  // namespace musclesim
