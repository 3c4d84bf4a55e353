/// `musclesim diagnose`: finds from recordings where the gap lies, which effect causes it, and how far the effect reduces it.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <set>

#include "commands.h"
#include "diagnose_arguments.h"
#include "interrupt.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/record_file.h"
#include "musclesim/base/text.h"
#include "musclesim/diagnosis/proposed_recording.h"
#include "musclesim/effect/effects_file.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/replay.h"
#include "musclesim/simulation/simulation.h"
#include "output_folder.h"
#include "progress.h"

namespace musclesim::command_line {

namespace {

constexpr const char* files_of_all_answers[] = {"diagnosis.json", "report.html", "effects.json"};
constexpr const char* kept_file = "unfinished.dat";  ///< the simulations of a diagnosis that has not ended yet
constexpr const char* files_of_some_answers[] = {"attempt.json", "nominal.toml", "next.csv", "next.json"};

std::filesystem::path folderFor(const DiagnoseArguments& arguments) {
  if (arguments.out) return *arguments.out;
  std::filesystem::path stem = arguments.recordings.front();
  return stem.replace_extension().string() + "-diagnosis";
}

/// Files that take their places together, once all of them are on the disk: a full disk leaves an earlier answer as it was.
class FilesTogether {
 public:
  void add(const std::filesystem::path& file, const std::string& text) {
    files_.push_back(std::make_unique<FileReplacement>(file.string(), text));
  }
  void commit() {
    for (const auto& file : files_) file->commit();
  }

 private:
  std::vector<std::unique_ptr<FileReplacement>> files_;
};

/// "2026-11-26 21:05".
std::string localTime() {
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(std::time(nullptr)));
}

/// Removes what a diagnosis that was killed while it wrote its answer has left: NAME.xxxx.tmp (FileReplacement).
void removeHalfWritten(const std::filesystem::path& folder) {
  const auto isOfAnswer = [](const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    const auto begins = [&](const char* answer) { return name.starts_with(std::string(answer) + "."); };
    return file.extension() == ".tmp" &&
           (std::ranges::any_of(files_of_all_answers, begins) || std::ranges::any_of(files_of_some_answers, begins));
  };
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (isOfAnswer(entry.path())) found.push_back(entry.path());
  for (const auto& file : found) std::filesystem::remove(file);
}

void writeAll(const Diagnosis& diagnosis, const std::filesystem::path& folder, const DiagnoseArguments& arguments,
              const std::vector<ActiveEffect>& effects_of_user, const RecordingInfo& plant, const std::string& command_line) {
  removeHalfWritten(folder);
  FilesTogether files;
  // Includes the fixed effects, so that the file describes the whole machine.
  const auto addEffects = [&](const char* file, const std::vector<ActiveEffect>& found) {
    std::vector<ActiveEffect> effects = effects_of_user;
    effects.insert(effects.end(), found.begin(), found.end());
    files.add(folder / file, effectsText(effects));
  };
  const std::string json = diagnosisJson(diagnosis);
  files.add(folder / "diagnosis.json", json);
  files.add(folder / "report.html", diagnosisReport(diagnosis, {localTime(), command_line}));
  addEffects("effects.json", diagnosis.chosen_effects);
  if (!diagnosis.attempt.effects.empty()) addEffects("attempt.json", diagnosis.attempt.active_effects);
  if (const std::string numbers = fittedNumbersToml(diagnosis); !numbers.empty()) files.add(folder / "nominal.toml", numbers);
  if (const ProposedRecording next = proposedRecording(diagnosis, plant, (folder / "next.json").string()); !next.csv.empty()) {
    files.add(folder / "next.csv", next.csv);
    files.add(folder / "next.json", next.json);
  }
  if (arguments.json) files.add(*arguments.json, json);
  for (const char* of_an_earlier_run : files_of_some_answers) std::filesystem::remove(folder / of_an_earlier_run);
  files.commit();
}

/// Checks before minutes of work that all outputs can be written and that none would overwrite an input.
void requirePlaces(const std::filesystem::path& folder, const ModelOptions& model, const DiagnoseArguments& arguments) {
  std::vector<std::string> inputs = arguments.recordings;
  for (const std::string& recording : arguments.recordings) inputs.push_back(sidecarPath(recording));
  for (const auto& file : {model.config, model.effects, arguments.fixed_effects})
    if (file) inputs.push_back(*file);
  for (const char* file : files_of_all_answers) requireOther(folder / file, inputs);
  for (const char* file : files_of_some_answers) requireOther(folder / file, inputs);
  if (arguments.json) {
    const std::filesystem::path file = *arguments.json;
    if (file.extension() != ".json") throw BadParameter("--json", file.string(), "end in .json (diagnosis.json is written there too)");
    requireOther(file, inputs);
    if (file.has_parent_path()) makeFolder(file.parent_path());
  }
  makeFolder(folder);
  requireWritable(folder);
}

void requireDifferent(std::vector<std::string> tuned) {
  std::ranges::sort(tuned);
  if (const auto twice = std::ranges::adjacent_find(tuned); twice != tuned.end())
    throw BadParameter("--tune", fmt::format("{},{}", *twice, *twice), "name each number once");
}

/// Begins to keep the simulations in the folder, or goes on from those of an unfinished diagnosis. Throws BadParameter if that is another.
void beginOrResume(RecordFile& kept, const std::string& origin, const std::filesystem::path& folder, const ModelOptions& model,
                   bool resume) {
  if (resume && !kept.origin().empty()) {
    requireSameOrigin(kept.origin(), origin, folder.string());
    const std::size_t count = kept.resume();
    say(model, fmt::format("goes on from {} simulations of the unfinished diagnosis in {}", count, folder.string()));
    if (const std::size_t dropped = kept.droppedBytes())
      say(model, fmt::format("the last {} bytes kept there are no whole simulation and are not used", dropped));
    return;
  }
  if (resume)
    say(model, fmt::format("{} holds no unfinished diagnosis: this one begins at the start", folder.string()));
  else if (!kept.origin().empty())
    say(model, fmt::format("the unfinished diagnosis in {} is begun anew; --resume would have gone on from it", folder.string()));
  kept.begin(origin);
}

/// Says which signals are not compared, and how a diagnosis of muscles that are chains of beads could take less time.
void noteModel(const RecordingInfo& plant, const std::vector<Recording>& recordings, const ReplayOptions& options,
               const ModelOptions& model) {
  Simulation simulation(simulationOptionsFor(plant, sidecarPath(recordings.front().file), options));
  const Robot& robot = simulation.build(plant.robot);
  for (const Recording& recording : recordings)
    for (const std::string& note : unknownSignalNotes(recording, robot)) say(model, note);
  if (std::ranges::any_of(simulation.world().actuators(), [](const auto& actuator) { return !actuator->hinges().empty(); }))
    say(model, "the muscles are chains of beads: as massless straight lines (--muscle line) they take less than a tenth of the time");
}

/// The diagnosis. One that is refused keeps nothing.
Diagnosis diagnosed(std::vector<Recording> recordings, const DiagnosisOptions& options) {
  try {
    return diagnose(std::move(recordings), options);
  } catch (const std::exception&) {
    options.kept->remove();
    throw;
  }
}

/// A finished diagnosis needs its simulations no longer.
void endKeeping(RecordFile& kept, bool finished, const ModelOptions& model) {
  if (const std::string why = kept.trouble(); !why.empty()) say(model, "the simulations could not be kept for --resume: " + why);
  if (finished)
    kept.remove();
  else
    say(model, "the same command with --resume goes on from here");
}

int diagnoseCommand(const ModelOptions& model, const DiagnoseArguments& arguments) {
  const std::filesystem::path folder = folderFor(arguments);
  requireDifferent(arguments.tune);
  std::vector<Recording> recordings;
  std::set<std::string> said;  // what holds for all recordings is said once
  for (const std::string& file : arguments.recordings) {
    recordings.push_back(readRecording(file, {arguments.ignore_columns}));
    if (arguments.without_active_effects) recordings.back().info.active_effects.clear();
    for (const auto& note : recordings.back().notes)
      if (said.insert(note).second) say(model, note);
  }
  requirePlaces(folder, model, arguments);
  DiagnosisOptions options;
  options.model = replayOptionsFrom(model);
  std::swap(options.earlier, options.model.effects);
  if (arguments.fixed_effects) options.model.effects = readEffects(*arguments.fixed_effects);
  options.candidates = arguments.candidates;
  options.exclude = arguments.exclude;
  options.tune = arguments.tune;
  options.smallest_gap_percent = arguments.smallest_gap_percent;
  options.max_effects = arguments.max_effects;
  options.trust_columns = arguments.trust_columns;
  options.skip_start_s = arguments.skip_start_s;
  options.job_count = arguments.jobs;
  options.seed = model.seed.value_or(1);
  options.interrupted = [] { return interruptSignal() != 0; };
  PhaseProgress progress(model.quiet);
  options.progress = [&](const DiagnosisProgress& now) { progress.show(now.phase, now.done, now.expected); };
  const RecordingInfo plant = diagnosedModel(recordings.front(), options.model);
  noteModel(plant, recordings, options.model, model);
  RecordFile kept((folder / kept_file).string());
  beginOrResume(kept, diagnosisOrigin(recordings, plant, model, arguments), folder, model, arguments.resume);
  options.kept = &kept;
  const Diagnosis diagnosis = diagnosed(std::move(recordings), options);
  writeAll(diagnosis, folder, arguments, options.model.effects, plant, model.command_line);
  endKeeping(kept, !diagnosis.partial, model);
  fmt::print("{}report    {}\n", diagnosisSummary(diagnosis), printable((folder / "report.html").string()));
  return diagnosis.partial ? interrupted_base + interruptSignal() : done;
}

}  // namespace

Action addDiagnose(CLI::App& command, ModelOptions& model) {
  auto arguments = std::make_shared<DiagnoseArguments>();
  command
      .add_option("recordings", arguments->recordings,
                  "Recordings of one plant; if there are several, the last one is held out to test the result")
      ->required();
  command.add_option("--out", arguments->out,
                     "Folder for report.html, diagnosis.json, effects.json and the rest (default: RECORDING-diagnosis)");
  command.add_option("--jobs", arguments->jobs, "Threads (default: one per core); the answer does not depend on it")
      ->check(CLI::Range(1, 1024));
  addList(command, "--candidates", arguments->candidates, "Consider only these effects, by id, separated by commas");
  addList(command, "--exclude", arguments->exclude, "Consider all effects except these, by id, separated by commas");
  addList(command, "--tune", arguments->tune,
          "Fit these unmeasured parameters of the model first, by name, separated by commas; written to nominal.toml");
  command.add_option("--max-effects", arguments->max_effects, "Largest number of effects that act together (default 4)")
      ->check(CLI::Range(1, most_effects));
  command
      .add_option(
          "--smallest-gap-percent", arguments->smallest_gap_percent,
          "A gap below this share of the motion in every signal counts as none (default 1); 0: look into every gap beyond the noise")
      ->check(CLI::Range(0.0, 100.0));
  command.add_option("--fixed-effects", arguments->fixed_effects, "JSON file with effects of the model that are not fitted");
  command.add_flag("--without-active-effects", arguments->without_active_effects,
                   "Compare with the model without the active_effects of the recordings' sidecars: look for them");
  command.add_flag("--resume", arguments->resume,
                   "Go on from a diagnosis of the same recordings with the same options that was killed or interrupted: repeats none of "
                   "the simulations kept in the folder of the answer");
  addList(command, "--ignore-columns", arguments->ignore_columns, "Columns to skip, separated by commas");
  command.add_flag("--trust-columns", arguments->trust_columns,
                   "Take units, zeros, signs and order of the columns as they are: do not refuse recordings in which they look wrong");
  command
      .add_option("--skip-start", arguments->skip_start_s,
                  "Seconds at the beginning of every recording whose readings are left out, because the machine had been moving (default: "
                  "skip_start_s of the sidecars, and 1 s of recordings that turn out to begin in motion); 0: none")
      ->check(CLI::Range(0.0, 1e5));
  addModelOptions(command, model);
  command.remove_option(command.get_option("--json"));
  command.get_option("--effects")
      ->description("JSON file with an earlier finding: its effects are fitted anew, and kept if they are still believed");
  command.add_option("--json", arguments->json, "Write a copy of diagnosis.json to FILE");
  return [&model, arguments] { return diagnoseCommand(model, *arguments); };
}

}  // namespace musclesim::command_line
