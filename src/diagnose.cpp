/// `musclesim diagnose`: finds from recordings where the gap lies, which effect causes it, and how far the effect reduces it.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "commands.h"
#include "interrupt.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/text.h"
#include "musclesim/diagnosis/proposed_recording.h"
#include "musclesim/effect/effects_file.h"
#include "output_folder.h"
#include "progress.h"

namespace musclesim::command_line {

namespace {

constexpr const char* files_of_all_answers[] = {"diagnosis.json", "report.html", "effects.json"};
constexpr const char* files_of_some_answers[] = {"attempt.json", "nominal.toml", "next.csv", "next.json"};

struct DiagnoseArguments {
  std::vector<std::string> recordings, candidates, exclude, ignore_columns, tune;
  std::optional<std::string> out, json, fixed_effects;
  int jobs = 0, max_effects = 4;
  bool without_active_effects = false;
};

std::filesystem::path folderFor(const DiagnoseArguments& arguments) {
  if (arguments.out) return *arguments.out;
  std::filesystem::path stem = arguments.recordings.front();
  return stem.replace_extension().string() + "-diagnosis";
}

/// Includes the fixed effects, so that the file describes the whole machine.
void writeWith(const std::vector<ActiveEffect>& found, std::vector<ActiveEffect> effects, const std::filesystem::path& file) {
  effects.insert(effects.end(), found.begin(), found.end());
  writeEffects(effects, file.string());
}

/// "2026-11-26 21:05".
std::string localTime() {
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(std::time(nullptr)));
}

void writeAll(const Diagnosis& diagnosis, const std::filesystem::path& folder, const DiagnoseArguments& arguments,
              const std::vector<ActiveEffect>& effects_of_user, const RecordingInfo& plant, const std::string& command_line) {
  for (const char* of_an_earlier_run : files_of_some_answers) std::filesystem::remove(folder / of_an_earlier_run);
  const std::string json = diagnosisJson(diagnosis);
  replaceFile((folder / "diagnosis.json").string(), json);
  replaceFile((folder / "report.html").string(), diagnosisReport(diagnosis, {localTime(), command_line}));
  writeWith(diagnosis.chosen_effects, effects_of_user, folder / "effects.json");
  if (!diagnosis.attempt.effects.empty()) writeWith(diagnosis.attempt.active_effects, effects_of_user, folder / "attempt.json");
  if (!diagnosis.tuned.empty()) replaceFile((folder / "nominal.toml").string(), tunedToml(diagnosis.tuned));
  if (const ProposedRecording next = proposedRecording(diagnosis, plant); !next.csv.empty()) {
    replaceFile((folder / "next.csv").string(), next.csv);
    replaceFile((folder / "next.json").string(), next.json);
  }
  if (arguments.json) replaceFile(*arguments.json, json);
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

int diagnoseCommand(const ModelOptions& model, const DiagnoseArguments& arguments) {
  const std::filesystem::path folder = folderFor(arguments);
  requireDifferent(arguments.tune);
  std::vector<Recording> recordings;
  for (const std::string& file : arguments.recordings) {
    recordings.push_back(readRecording(file, {arguments.ignore_columns}));
    if (arguments.without_active_effects) recordings.back().info.active_effects.clear();
    for (const auto& note : recordings.back().notes) say(model, note);
  }
  requirePlaces(folder, model, arguments);
  DiagnosisOptions options;
  options.model = replayOptionsFrom(model);
  std::swap(options.earlier, options.model.effects);
  if (arguments.fixed_effects) options.model.effects = readEffects(*arguments.fixed_effects);
  options.candidates = arguments.candidates;
  options.exclude = arguments.exclude;
  options.tune = arguments.tune;
  options.max_effects = arguments.max_effects;
  options.job_count = arguments.jobs;
  options.seed = model.seed.value_or(1);
  options.interrupted = [] { return interruptSignal() != 0; };
  PhaseProgress progress(model.quiet);
  options.progress = [&](const DiagnosisProgress& now) { progress.show(now.phase, now.done, now.expected); };
  const RecordingInfo plant = diagnosedModel(recordings.front(), options.model);
  const Diagnosis diagnosis = diagnose(std::move(recordings), options);
  writeAll(diagnosis, folder, arguments, options.model.effects, plant, model.command_line);
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
      ->check(CLI::Range(1, 6));
  command.add_option("--fixed-effects", arguments->fixed_effects, "JSON file with effects of the model that are not fitted");
  command.add_flag("--without-active-effects", arguments->without_active_effects,
                   "Compare with the model without the active_effects of the recordings' sidecars: look for them");
  addList(command, "--ignore-columns", arguments->ignore_columns, "Columns to skip, separated by commas");
  addModelOptions(command, model);
  command.remove_option(command.get_option("--json"));
  command.get_option("--effects")
      ->description("JSON file with an earlier finding: its effects are fitted anew, and kept if they are still believed");
  command.add_option("--json", arguments->json, "Write a copy of diagnosis.json to FILE");
  return [&model, arguments] { return diagnoseCommand(model, *arguments); };
}

}  // namespace musclesim::command_line
