#include "musclesim/simulation/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "../effect/components.h"
#include "internal_step.h"
#include "musclesim/base/error.h"
#include "musclesim/controller/replay.h"
#include "musclesim/robot/robot_file.h"
#include "musclesim/robot/robot_registry.h"
#include "musclesim/version.h"
#include "recorded_pulls.h"

namespace musclesim {

namespace {

constexpr double default_step_s = 0.01;

void appendRow(Recording& recording, double time_s, const std::vector<double>& values) {
  recording.time_s.push_back(time_s);
  for (std::size_t i = 0; i < values.size(); ++i) recording.signals[i].values.push_back(values[i]);
}

/// Number of internal steps that the sidecar of a run of this program states; 0 if it states none or the automatic number, which may change
/// with other parameters.
int recordedSubsteps(const RecordingInfo& info) {
  const auto extra = nlohmann::json::parse(info.extra_json, nullptr, false);
  if (!extra.is_object() || !extra.contains("substeps") || !extra["substeps"].is_number_integer()) return 0;
  if (const auto automatic = extra.find("substeps_automatic"); automatic != extra.end() && *automatic == true) return 0;
  return extra["substeps"].get<int>();
}

constexpr const char* plane_height = "world.plane_height_mm";
constexpr std::array<const char*, 4> model_groups = {"physics.", "muscle.", "force_law.", "world."};

nlohmann::json toJson(const Parameter::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::get<std::string>(value);
}

/// Parameters that a replay needs to rebuild the robot: the robot's own, all others of the model that differ from their defaults, and the
/// ground plane's height if there is a plane.
std::map<std::string, Parameter::Value> robotParameters(Simulation& simulation) {
  std::map<std::string, Parameter::Value> result;
  const std::string own = simulation.robot().name() + ".";
  // Controllers and tasks have parameters too, but a replay has neither.
  const auto belongsToModel = [](const std::string& name) {
    return std::any_of(model_groups.begin(), model_groups.end(), [&](const char* group) { return name.starts_with(group); });
  };
  for (const Parameter& p : simulation.parameters().declared()) {
    if (p.name.starts_with(own))
      result[p.name.substr(own.size())] = p.value;
    else if (p.name == plane_height || (belongsToModel(p.name) && p.value != p.default_value))
      result[p.name] = p.value;
  }
  return result;
}

void requireRegistered(const std::string& robot, const std::string& source) {
  if (isRobotFile(robot)) return;  // errors about it name the file itself
  std::vector<std::string> names;
  for (const auto& [name, description] : registeredRobots()) names.push_back(name);
  if (std::ranges::find(names, robot) == names.end())
    throw BadFile(source, fmt::format("there is no robot \"{}\"; registered: {}", robot, fmt::join(names, ", ")));
}

/// Whether a signal comes from the run's task or controller and not from its robot.
bool isOfTask(const std::string& signal) {
  return signal == "activity" || signal.starts_with("target_") || signal.starts_with("controller_");
}

/// Signals of a recording that lose samples to an effect.
std::vector<const Signal*> signalsHeldBy(const ActiveEffect& effect, const Recording& recording) {
  std::vector<const Signal*> held;
  if (effect.id != held_effect) return held;
  for (const Signal& signal : recording.signals)
    if (!signal.name.starts_with("command_") && (effect.component == "all" || effect.component == "signal_" + stemOf(signal.name)))
      held.push_back(&signal);
  return held;
}

/// Repeats the pulls of a recording.
class Pulls {
 public:
  /// Another robot has other bodies: it is not pulled at.
  Pulls(const RecordingInfo& info, const std::string& source, bool same_robot) {
    if (same_robot) pulls_ = recordedPulls(info, source);
  }

  /// Applies the pull of a row at this time.
  void apply(Simulation& simulation, double time_s) {
    for (; next_ < pulls_.size() && pulls_[next_].time_s < time_s + simulation.stepS() / 2; ++next_) simulation.pull(pulls_[next_].pull);
  }

 private:
  std::vector<TimedPull> pulls_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<std::string> unknownSignalNotes(const Recording& recording, const Robot& robot) {
  const std::vector<std::string> names = robot.signalNames();
  std::vector<std::string> notes;
  for (const Signal& signal : recording.signals) {
    if (isOfTask(signal.name) || std::ranges::find(names, signal.name) != names.end()) continue;
    const std::string nearest = nearestName(signal.name, names);
    notes.push_back(fmt::format("{}: {} has no {}; it is not compared{}", recording.file, robot.name(), signal.name,
                                nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest)));
  }
  return notes;
}

RecordingInfo describeModel(Simulation& simulation, const std::string& initial_state) {
  RecordingInfo info;
  const Robot& robot = simulation.robot();
  info.robot = robot.descriptionFile().empty() ? robot.name() : robot.descriptionFile();
  info.robot_hash = robot.descriptionHash();
  info.physics = nameOf(simulation.physics().kind);
  info.initial_state = initial_state;
  info.robot_parameters = robotParameters(simulation);
  info.active_effects = simulation.effects().active();
  info.noise_std = simulation.effects().noise();
  info.seed = simulation.seed();
  info.step_s = simulation.stepS();
  info.program = "musclesim " MUSCLESIM_VERSION;
  nlohmann::json extra;
  extra["stepper"] = simulation.stepper().name();
  extra["substeps"] = simulation.substeps();
  extra["substeps_automatic"] = simulation.substeps() == automaticSubsteps(simulation.stepS(), simulation.physics(),
                                                                           simulation.world().joints(), simulation.world().actuators());
  extra["internal_step_s"] = simulation.internalStepS();
  for (const Parameter& p : simulation.parameters().declared()) extra["parameters"][p.name] = toJson(p.value);
  info.extra_json = extra.dump();
  return info;
}

std::string otherDescriptionNote(const RecordingInfo& info, const Robot& robot) {
  if (info.robot_hash.empty() || info.robot_hash == robot.descriptionHash()) return "";
  return fmt::format("the description of the robot ({}) is not the one with which the recording was made: its text has changed",
                     info.robot);
}

void replaceRobot(RecordingInfo& info, const std::optional<std::string>& robot) {
  if (!robot || *robot == info.robot) return;
  std::erase_if(info.robot_parameters, [](const auto& entry) { return entry.first.find('.') == std::string::npos; });
  info.robot = *robot;
  info.robot_hash.clear();
}

SimulationOptions simulationOptionsFor(const RecordingInfo& info, const std::string& source, const ReplayOptions& options) {
  if (!options.robot) requireRegistered(info.robot, source);
  SimulationOptions result;
  result.physics = options.physics ? *options.physics : physicsFromName(info.physics.value_or("si"));
  result.step_s = options.step_s.value_or(info.step_s.value_or(default_step_s));
  result.stepper = options.stepper;
  result.substeps = options.substeps;
  // A run of this program is replayed with its own number of internal steps unless the user changes the physics or the step.
  if (options.substeps == 0 && !options.physics && !options.step_s) result.substeps = recordedSubsteps(info);
  result.plane = options.plane || info.robot_parameters.contains(plane_height);
  result.seed = options.seed.value_or(info.seed.value_or(1));
  result.interrupted = options.interrupted;
  result.body_moves = options.body_moves;
  const std::string group = isRobotFile(info.robot) ? nameOfRobotFile(info.robot) : info.robot;
  for (const auto& [name, value] : info.robot_parameters)
    result.parameters.setFromFile(name.find('.') == std::string::npos ? group + "." + name : name, value, source);
  result.parameters.setAll(options.parameters);
  result.effects = info.active_effects;
  result.effects.insert(result.effects.end(), options.effects.begin(), options.effects.end());
  return result;
}

void holdWhereMeasured(std::vector<double>& predicted, const std::vector<double>& measured) {
  for (std::size_t row = 1; row < std::min(predicted.size(), measured.size()); ++row)
    if (measured[row] == measured[row - 1]) predicted[row] = predicted[row - 1];
}

ReplayResult replayRecording(const Recording& recording, const ReplayOptions& options) {
  RecordingInfo info = recording.info;
  replaceRobot(info, options.robot);
  std::vector<ActiveEffect> held;
  ReplayOptions drawn = options;
  std::erase_if(drawn.effects, [&](const ActiveEffect& effect) {
    if (signalsHeldBy(effect, recording).empty()) return false;
    effectValues(effectInfo(effect.id), effect);  // throws for wrong parameters
    held.push_back(effect);
    return true;
  });
  Simulation simulation(simulationOptionsFor(info, sidecarPath(recording.file), drawn));
  Robot& robot = simulation.build(info.robot);
  simulation.parameters().requireAllKnown();
  if (options.most_substeps > 0 && simulation.substeps() > options.most_substeps)
    throw BadParameter("substeps", std::to_string(simulation.substeps()), fmt::format("be at most {}", options.most_substeps));
  ReplayController commands(recording, robot.actuatorCount());
  Pulls pulls(recording.info, sidecarPath(recording.file), info.robot == recording.info.robot);

  ReplayResult result;
  result.substeps = simulation.substeps();
  result.stepper = simulation.stepper().name();
  result.simulated.info = describeModel(simulation, options.initial_state.value_or(info.initial_state.value_or(robot.initialState())));
  result.simulated.info.description = info.description;
  result.simulated.info.trial = info.trial;
  const ReplayOptions::Watcher watcher = options.watch ? options.watch(simulation) : nullptr;
  result.simulated.time_s.reserve(recording.time_s.size());
  for (const auto& name : robot.signalNames()) {
    result.simulated.signals.push_back({name, {}});
    result.simulated.signals.back().values.reserve(recording.time_s.size());
  }
  try {
    for (std::size_t row = 0; row < recording.time_s.size(); ++row) {
      State now;  // recorded commands depend on the time alone
      now.time_s = recording.time_s[row];
      const Action action = commands.output(now);
      if (row == 0)
        simulation.start(*result.simulated.info.initial_state, action);
      else
        robot.step(action);
      pulls.apply(simulation, recording.time_s[row]);
      State reading = robot.getState();
      reading.time_s = recording.time_s[row];
      appendRow(result.simulated, recording.time_s[row], robot.signalValues(reading));
      if (watcher) watcher(reading);
      if (row + 1 < recording.time_s.size()) simulation.advance(recording.time_s[row + 1] - recording.time_s[row]);
    }
  } catch (const Diverged& error) {
    result.divergence = error.what();
  } catch (const Interrupted&) {
    result.interrupted = true;
  }
  for (const ActiveEffect& effect : held) {
    result.simulated.info.active_effects.push_back(effect);
    for (const Signal* measured : signalsHeldBy(effect, recording))
      for (Signal& signal : result.simulated.signals)
        if (signal.name == measured->name) holdWhereMeasured(signal.values, measured->values);
  }
  result.simulated.info.complete = !result.divergence && !result.interrupted;
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
