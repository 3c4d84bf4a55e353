/// `musclesim replay`: a recording's commands through the model, and how far the model is off.
#include "musclesim/simulation/replay.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "interrupt.h"
#include "musclesim/error.h"
#include "pictures.h"

namespace musclesim::program {

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
    fmt::print("{:<20} {:>12.4g} {:>12.4g} {:>9}  {}\n", e.name, e.rmse, e.largest, e.sample_count, unitOf(e.name));
}

/// Thrown between two rows.
struct Interruption {};

int reportInterruption(const ModelOptions& model, const ReplayArguments& arguments) {
  say(model, "interrupted; pictures show the replay up to then, nothing is compared");
  if (model.json)
    fmt::print("{}\n", nlohmann::json{{"command", "replay"}, {"recording", arguments.recording}, {"status", "interrupted"}}.dump());
  return interrupted_base + interruptSignal();
}

nlohmann::json verdictOf(const ReplayResult& result, const ReplayArguments& arguments) {
  nlohmann::json json;
  json["command"] = "replay";
  json["recording"] = arguments.recording;
  json["status"] = result.divergence ? "diverged" : "done";
  if (result.divergence) json["message"] = *result.divergence;
  if (arguments.out) json["out"] = *arguments.out;
  json["stepper"] = result.stepper;
  json["substeps"] = result.substeps;
  json["worst_joint_gap_mm"] = result.worst_gap.gap_mm;
  for (const SignalError& e : result.errors)
    json["signals"][e.name] = {{"rmse", e.rmse}, {"largest", e.largest}, {"samples", e.sample_count}};
  return json;
}

int replay(const ModelOptions& model, const ReplayArguments& arguments) {
  const Recording recording = readRecording(arguments.recording, {arguments.ignore_columns});
  for (const auto& note : recording.notes) say(model, note);
  std::unique_ptr<Spectator> spectator;
  ReplayOptions options = replayOptionsFrom(model);
  options.watch = [&](Simulation& simulation) {
    if (arguments.pictures.wanted()) spectator = makePictures(arguments.pictures, simulation);
    return [&](const State& state) {
      if (spectator) spectator->see(state);
      if (interruptSignal() != 0) throw Interruption{};
    };
  };
  ReplayResult result;
  try {
    result = replayRecording(recording, options);
  } catch (const Interruption&) {
    if (spectator) spectator->finish();
    return reportInterruption(model, arguments);
  }
  if (spectator) spectator->finish();
  if (arguments.out) writeRecording(result.simulated, *arguments.out);
  printTable(result);
  if (result.divergence) std::fprintf(stderr, "musclesim: error: %s\n", result.divergence->c_str());
  if (model.json) fmt::print("{}\n", verdictOf(result, arguments).dump());
  return result.divergence ? diverged : done;
}

}  // namespace

Action addReplay(CLI::App& command, ModelOptions& model) {
  auto arguments = std::make_shared<ReplayArguments>();
  command.add_option("recording", arguments->recording, "Recording, NAME.csv with NAME.json beside it")->required();
  command.add_option("--out", arguments->out, "Write what the model measures, at the recording's times, to SIM.csv");
  command.add_option("--ignore-columns", arguments->ignore_columns, "Columns to skip, separated by commas")->delimiter(',');
  addPictureOptions(command, arguments->pictures, "Pictures");
  addModelOptions(command, model);
  return [&model, arguments] { return replay(model, *arguments); };
}

}  // namespace musclesim::program
