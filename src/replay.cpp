/// `musclesim replay`: simulates a recording's commands and compares the result with its measurements.
#include "musclesim/simulation/replay.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "interrupt.h"
#include "musclesim/log/recorder.h"
#include "output_folder.h"
#include "pictures.h"

namespace musclesim::command_line {

namespace {

struct ReplayArguments {
  std::string recording;
  std::optional<std::string> out;
  std::vector<std::string> ignore_columns;
  PictureOptions pictures;
};

std::string unitOf(const std::string& signal) {
  const auto underscore = signal.rfind('_');
  const std::string tail = signal.substr(underscore + 1);
  return tail == "mm" || tail == "deg" || tail == "N" ? tail : "of full scale";
}

void printTable(const ReplayResult& result) {
  fmt::print("{:<20} {:>12} {:>12} {:>9}\n", "signal", "RMSE", "largest", "samples");
  for (const SignalError& e : result.errors)
    if (e.sample_count > 0)
      fmt::print("{:<20} {:>12.4g} {:>12.4g} {:>9}  {}\n", e.name, e.rmse, e.largest, e.sample_count, unitOf(e.name));
    else
      fmt::print("{:<20} {:>12} {:>12} {:>9}  nothing to compare\n", e.name, "-", "-", 0);
}

nlohmann::json verdictOf(const ReplayResult& result, const ReplayArguments& arguments) {
  nlohmann::json json;
  json["command"] = "replay";
  json["recording"] = arguments.recording;
  json["status"] = result.divergence ? "diverged" : result.interrupted ? "interrupted" : "done";
  if (result.divergence) json["message"] = *result.divergence;
  if (arguments.out) json["out"] = *arguments.out;
  json["stepper"] = result.stepper;
  json["substeps"] = result.substeps;
  json["worst_joint_gap_mm"] = result.worst_gap.gap_mm;
  for (const SignalError& e : result.errors) {
    const bool is_compared = e.sample_count > 0;
    json["signals"][e.name] = {{"rmse", is_compared ? nlohmann::json(e.rmse) : nullptr},
                               {"largest", is_compared ? nlohmann::json(e.largest) : nullptr},
                               {"samples", e.sample_count}};
  }
  return json;
}

int replay(const ModelOptions& model, const ReplayArguments& arguments) {
  arguments.pictures.requireUsed();
  if (arguments.out) {
    for (const std::string& written : {*arguments.out, sidecarPath(*arguments.out)})
      requireOther(written, {arguments.recording, sidecarPath(arguments.recording)});
    requireReplaceable(*arguments.out);
    prepareRecording(*arguments.out);
  }
  const Recording recording = readRecording(arguments.recording, {arguments.ignore_columns});
  for (const auto& note : recording.notes) say(model, note);
  std::unique_ptr<Spectator> spectator;
  ReplayOptions options = replayOptionsFrom(model);
  options.watch = [&](Simulation& simulation) {
    if (arguments.pictures.wanted()) spectator = makePictures(arguments.pictures, simulation);
    if (const std::string note = otherDescriptionNote(recording.info, simulation.robot()); !note.empty()) say(model, note);
    for (const std::string& name : unknownSignals(recording, simulation.robot().signalNames()))
      say(model, fmt::format("{}: {} has no {}; it is not compared", arguments.recording, simulation.robot().name(), name));
    return [&](const State& state) {
      if (spectator) spectator->see(state);
    };
  };
  options.interrupted = [] { return interruptSignal() != 0; };
  const ReplayResult result = replayRecording(recording, options);
  if (spectator) spectator->finish();
  if (arguments.out && !result.simulated.time_s.empty()) writeRecording(result.simulated, *arguments.out);
  if (result.interrupted)
    say(model, fmt::format("interrupted; the results cover {} of {} rows", result.simulated.time_s.size(), recording.time_s.size()));
  printTable(result);
  if (result.divergence) std::fprintf(stderr, "musclesim: error: %s\n", result.divergence->c_str());
  if (model.json) fmt::print("{}\n", verdictOf(result, arguments).dump());
  if (result.interrupted) return interrupted_base + interruptSignal();
  return result.divergence ? diverged : done;
}

}  // namespace

Action addReplay(CLI::App& command, ModelOptions& model) {
  auto arguments = std::make_shared<ReplayArguments>();
  command.add_option("recording", arguments->recording, "Recording, NAME.csv with NAME.json beside it")->required();
  command.add_option("--out", arguments->out, "Write the simulated readings, at the recording's times, to SIM.csv");
  addList(command, "--ignore-columns", arguments->ignore_columns, "Columns to skip, separated by commas");
  addPictureOptions(command, arguments->pictures, "Pictures");
  addModelOptions(command, model);
  return [&model, arguments] { return replay(model, *arguments); };
}

}  // namespace musclesim::command_line
