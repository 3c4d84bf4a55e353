/// `musclesim schedule`: writes a test signal as a table of commands, to be played by a machine or by the simulator.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/controller/controller_registry.h"
#include "musclesim/controller/test_signal.h"
#include "musclesim/log/recorder.h"
#include "output_folder.h"

namespace musclesim::command_line {

namespace {

struct ScheduleArguments {
  std::string signal, out;
  double duration_s = 20;
  std::optional<std::string> channels;
  std::optional<double> full_scale_kPa, full_scale_V;
};

std::vector<std::string> signalNames() {
  std::vector<std::string> names;
  for (const TestSignalInfo& signal : testSignals()) names.push_back(signal.name);
  return names;
}

std::unique_ptr<Simulation> simulationFor(const ModelOptions& model) {
  RecordingInfo plant;
  plant.robot = model.robot.value_or("arm");
  auto simulation = std::make_unique<Simulation>(simulationOptionsFor(plant, plant.robot, replayOptionsFrom(model)));
  simulation->build(plant.robot);
  return simulation;
}

/// The commands at every control step, as a recording without measurements.
Recording scheduleOf(Simulation& simulation, Controller& controller, const ScheduleArguments& arguments) {
  Recording recording;
  recording.info = describeModel(simulation, simulation.robot().initialState());
  recording.info.description = fmt::format("{} for {}", arguments.signal, recording.info.robot);
  recording.info.trial = arguments.signal;
  for (int i = 0; i < simulation.robot().actuatorCount(); ++i) recording.signals.push_back({fmt::format("command_{}", i), {}});
  const long row_count = std::lround(arguments.duration_s / simulation.stepS());
  State state;
  for (long row = 0; row <= row_count; ++row) {
    state.time_s = static_cast<double>(row) * simulation.stepS();  // as the clock of a run
    recording.time_s.push_back(state.time_s);
    const musclesim::Action action = controller.output(state);
    for (std::size_t i = 0; i < action.size(); ++i) recording.signals[i].values.push_back(action[i]);
  }
  return recording;
}

/// Writes the commands in the unit of a full scale, which the sidecar gives.
void writeInUnit(Recording& recording, const std::string& unit, double full_scale, const std::string& csv) {
  std::string table = "time_s";
  for (const Signal& signal : recording.signals) table += fmt::format(",{}_{}", signal.name, unit);
  table += '\n';
  for (std::size_t row = 0; row < recording.time_s.size(); ++row) {
    table += fmt::format("{}", recording.time_s[row]);
    for (const Signal& signal : recording.signals) table += fmt::format(",{}", signal.values[row] * full_scale);
    table += '\n';
  }
  (unit == "V" ? recording.info.command_full_scale_V : recording.info.pressure_full_scale_kPa) = full_scale;
  const std::string sidecar = sidecarPath(csv);
  replaceFile(sidecar, sidecarText(recording.info, sidecar));
  replaceFile(csv, table);
}

int schedule(const ModelOptions& model, const ScheduleArguments& arguments) {
  constexpr double longest_schedule_s = 1e6;
  if (!(arguments.duration_s > 0 && arguments.duration_s <= longest_schedule_s))
    throw BadParameter("duration", fmt::format("{} s", arguments.duration_s),
                       fmt::format("lie above 0 and at most {:g} s", longest_schedule_s));
  const auto simulation = simulationFor(model);
  ControllerRequest request{simulation->parameters()};
  request.muscle_count = simulation->robot().actuatorCount();
  request.step_s = simulation->stepS();
  request.seed = simulation->seed();
  request.robot = &simulation->robot();
  request.channels = arguments.channels.value_or("");
  TestSignalController controller(arguments.signal, request);
  simulation->parameters().requireAllKnown();
  const std::filesystem::path csv = arguments.out;
  requireReplaceable(csv.string());
  if (prepareRecording(csv)) say(model, fmt::format("made the folder {}", csv.parent_path().string()));
  for (const std::string& note : controller.notes()) say(model, note);
  Recording recording = scheduleOf(*simulation, controller, arguments);
  if (arguments.full_scale_kPa)
    writeInUnit(recording, "kPa", *arguments.full_scale_kPa, arguments.out);
  else if (arguments.full_scale_V)
    writeInUnit(recording, "V", *arguments.full_scale_V, arguments.out);
  else
    writeRecording(recording, arguments.out);
  fmt::print("schedule  {}\n", arguments.out);
  if (model.json)
    fmt::print("{}\n", nlohmann::json{{"command", "schedule"},
                                      {"status", "done"},
                                      {"signal", arguments.signal},
                                      {"schedule", arguments.out},
                                      {"rows", recording.time_s.size()}}
                           .dump());
  return done;
}

}  // namespace

Action addSchedule(CLI::App& command, ModelOptions& model) {
  auto arguments = std::make_shared<ScheduleArguments>();
  command.add_option("signal", arguments->signal, fmt::format("Test signal: {}", fmt::join(signalNames(), ", ")))
      ->required()
      ->check(CLI::IsMember(signalNames()));
  command.add_option("-o,--out", arguments->out, "Table to write: FILE.csv, with FILE.json beside it")->required();
  command.add_option("--duration", arguments->duration_s, "Time to the last row in s")->capture_default_str();
  command
      .add_option(
          "--channels", arguments->channels,
          "What the signal moves: muscles 0,1, antagonists 0:1, groups 0+2:1+3 (default: the robot's antagonists, else all muscles)")
      ->option_text("CHANNEL,...");
  const CLI::Range full_scales(1e-3, 1e5);
  CLI::Option* in_kPa =
      command.add_option("--full-scale-kPa", arguments->full_scale_kPa, "Write commands in kPa: the pressure of a command of 1")
          ->check(full_scales);
  command.add_option("--full-scale-V", arguments->full_scale_V, "Write commands in V: the voltage of a command of 1")
      ->check(full_scales)
      ->excludes(in_kPa);
  addModelOptions(command, model);
  return [&model, arguments] { return schedule(model, *arguments); };
}

}  // namespace musclesim::command_line
