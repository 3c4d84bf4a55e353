/// `musclesim replay`: simulates a recording's commands and compares the result with its measurements.
#include "musclesim/simulation/replay.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "diagnosis/report/gap_figure.h"
#include "interrupt.h"
#include "log/figure_file.h"
#include "musclesim/base/error.h"
#include "musclesim/base/text.h"
#include "musclesim/log/recorder.h"
#include "output_folder.h"
#include "pictures.h"
#include "replay_window.h"

namespace musclesim::command_line {

namespace {

namespace fs = std::filesystem;

struct ReplayArguments {
  std::string recording;
  std::optional<std::string> out, figure;
  std::vector<std::string> ignore_columns;
  bool window = false;
  std::string window_log;
  PictureOptions pictures;

  /// Where the figure goes: beside the simulated readings unless it has a name of its own.
  std::optional<std::string> figureFile() const {
    if (figure || !out) return figure;
    return fs::path(*out).replace_extension(".svg").string();
  }
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
  if (const auto figure = arguments.figureFile()) json["figure"] = *figure;
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

/// Throws before the simulation what would fail after it.
void prepareOutputs(const ReplayArguments& arguments) {
  if (!arguments.window) arguments.pictures.requireUsed("there is no --window");
  if (!arguments.window && !arguments.window_log.empty()) throw BadParameter("--window-log needs --window");
  const std::vector<std::string> inputs = {arguments.recording, sidecarPath(arguments.recording)};
  if (const auto figure = arguments.figureFile()) {
    requireFigureFile(*figure);
    requireOther(*figure, inputs);
    if (fs::path(*figure).has_parent_path()) makeFolder(fs::path(*figure).parent_path());
  }
  if (!arguments.out) return;
  for (const std::string& written : {*arguments.out, sidecarPath(*arguments.out)}) requireOther(written, inputs);
  requireReplaceable(*arguments.out);
  prepareRecording(*arguments.out);
}

void writeOutputs(const ReplayArguments& arguments, const Recording& recording, const ReplayResult& result) {
  if (result.simulated.time_s.empty()) return;
  if (arguments.out) writeRecording(result.simulated, *arguments.out);
  if (const auto figure = arguments.figureFile())
    writeFigure(*figure, gapFigureSvg(fmt::format("{}: measured and simulated", fs::path(arguments.recording).filename().string()),
                                      replayGaps(recording, result.simulated)));
}

/// Pictures and the window of a replay, with the measured poses as ghosts; nothing if neither is wanted.
class Views {
 public:
  Views(const ModelOptions& model, const ReplayArguments& arguments, const Recording& recording, const ReplayOptions& options)
      : arguments_(arguments) {
    if (!arguments.window && !arguments.pictures.wanted()) return;
    poses_ = std::make_unique<MeasuredPoses>(recording, options);
    say(model,
        (poses_->areDetermined() ? "the measured pose, drawn as a ghost, follows " : "no measured pose is drawn: ") + poses_->reason());
    const fs::path folder = arguments.out ? fs::path(*arguments.out).parent_path() : fs::path();
    if (arguments.window)
      window_ = makeReplayWindow(recording, options, *poses_,
                                 {arguments.pictures, folder.empty() ? "." : folder.string(), arguments.window_log, model.quiet});
  }

  ReplayOptions::Watcher watch(Simulation& simulation) {
    if (arguments_.pictures.wanted())
      pictures_ = makePictures(arguments_.pictures, simulation,
                               [this](std::size_t row, const Snapshot& simulated) { return poses_->at(row, simulated); });
    const ReplayOptions::Watcher keep = window_ ? window_->watch(simulation) : nullptr;
    return [this, keep](const State& state) {
      if (pictures_) pictures_->see(state);
      if (keep) keep(state);
    };
  }

  void finishPictures() {
    if (pictures_) pictures_->finish();
  }

  void show(const ReplayResult& result) {
    std::fflush(stdout);
    if (window_ && !result.interrupted) window_->show(result);
  }

 private:
  const ReplayArguments& arguments_;
  std::unique_ptr<MeasuredPoses> poses_;
  std::unique_ptr<ReplayWindow> window_;
  std::unique_ptr<Spectator> pictures_;
};

void sayWhatIsOdd(const ModelOptions& model, const Recording& recording, const Robot& robot) {
  if (const std::string note = otherDescriptionNote(recording.info, robot); !note.empty()) say(model, note);
  for (const std::string& note : unknownSignalNotes(recording, robot)) say(model, note);
}

int replay(const ModelOptions& model, const ReplayArguments& arguments) {
  prepareOutputs(arguments);
  const Recording recording = readRecording(arguments.recording, {arguments.ignore_columns});
  for (const auto& note : recording.notes) say(model, note);
  ReplayOptions options = replayOptionsFrom(model);
  options.interrupted = [] { return interruptSignal() != 0; };
  Views views(model, arguments, recording, options);
  options.watch = [&](Simulation& simulation) {
    sayWhatIsOdd(model, recording, simulation.robot());
    return views.watch(simulation);
  };
  const ReplayResult result = replayRecording(recording, options);
  views.finishPictures();
  writeOutputs(arguments, recording, result);
  if (result.interrupted)
    say(model, fmt::format("interrupted; the results cover {} of {} rows", result.simulated.time_s.size(), recording.time_s.size()));
  printTable(result);
  if (const auto figure = arguments.figureFile(); figure && !result.simulated.time_s.empty())
    fmt::print("figure  {}\n", printable(*figure));
  if (result.divergence) tell("error: " + *result.divergence);
  views.show(result);
  if (model.json) fmt::print("{}\n", verdictOf(result, arguments).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  if (interruptSignal() != 0) return interrupted_base + interruptSignal();
  return result.divergence ? diverged : done;
}

}  // namespace

Action addReplay(CLI::App& command, ModelOptions& model) {
  auto arguments = std::make_shared<ReplayArguments>();
  command.add_option("recording", arguments->recording, "Recording, NAME.csv with NAME.json beside it")->required();
  command.add_option("--out", arguments->out,
                     "Write the simulated readings, at the recording's times, to SIM.csv, and the figure of the gap to SIM.svg");
  command.add_option("--figure", arguments->figure,
                     "Figure of the gap, FILE.svg or FILE.png: measured, simulated and residual of every signal, and loops");
  addList(command, "--ignore-columns", arguments->ignore_columns, "Columns to skip, separated by commas");
  command
      .add_flag("--window", arguments->window,
                "Play the replay in a window: the measured pose as a ghost over the simulated robot, a time line, --effects on and off")
      ->group("Pictures");
  command
      .add_option("--window-log", arguments->window_log,
                  "Log the user's actions in the window to FILE: one line of JSON per key or click, with the state after it")
      ->group("Pictures");
  addPictureOptions(command, arguments->pictures, "Pictures");
  addModelOptions(command, model);
  return [&model, arguments] { return replay(model, *arguments); };
}

}  // namespace musclesim::command_line
