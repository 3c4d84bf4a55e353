/// `musclesim diagnose`: from recordings to where the gap lies, which effect causes it and how far it shrinks.
#include <fmt/format.h>

#include <filesystem>

#include "commands.h"
#include "interrupt.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/effect/effects_file.h"
#include "musclesim/error.h"
#include "musclesim/log/file.h"
#include "progress.h"

namespace musclesim::program {

namespace {

struct DiagnoseArguments {
  std::vector<std::string> recordings, candidates, exclude, ignore_columns;
  std::optional<std::string> out, json;
  int jobs = 0, max_effects = 2;
};

std::filesystem::path folderFor(const DiagnoseArguments& arguments) {
  if (arguments.out) return *arguments.out;
  std::filesystem::path stem = arguments.recordings.front();
  return stem.replace_extension().string() + "-diagnosis";
}

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

void writeAll(const Diagnosis& diagnosis, const std::filesystem::path& folder, const DiagnoseArguments& arguments) {
  std::filesystem::create_directories(folder);
  const std::string json = diagnosisJson(diagnosis);
  replaceFile((folder / "diagnosis.json").string(), json);
  if (arguments.json) replaceFile(*arguments.json, json);
  replaceFile((folder / "report.html").string(), diagnosisReport(diagnosis));
  writeEffects(diagnosis.chosen_effects, (folder / "effects.json").string());
  if (!diagnosis.next_experiment.commands.empty()) replaceFile((folder / "next.csv").string(), scheduleText(diagnosis.next_experiment));
}

int diagnoseCommand(const ModelOptions& model, const DiagnoseArguments& arguments) {
  std::vector<Recording> recordings;
  for (const std::string& file : arguments.recordings) {
    recordings.push_back(readRecording(file, {arguments.ignore_columns}));
    for (const auto& note : recordings.back().notes) say(model, note);
  }
  DiagnosisOptions options;
  options.model = replayOptionsFrom(model);
  options.candidates = arguments.candidates;
  options.exclude = arguments.exclude;
  options.max_effects = arguments.max_effects;
  options.job_count = arguments.jobs;
  options.seed = model.seed;
  options.interrupted = [] { return interruptSignal() != 0; };
  PhaseProgress progress(model.quiet);
  options.progress = [&](const DiagnosisProgress& now) { progress.show(now.phase, now.done, now.expected); };
  const Diagnosis diagnosis = diagnose(std::move(recordings), options);
  const std::filesystem::path folder = folderFor(arguments);
  writeAll(diagnosis, folder, arguments);
  if (!model.quiet) fmt::print("{}report    {}\n", diagnosisSummary(diagnosis), (folder / "report.html").string());
  return diagnosis.partial ? interrupted_base + 2 : done;
}

}  // namespace

Action addDiagnose(CLI::App& command, ModelOptions& model) {
  auto arguments = std::make_shared<DiagnoseArguments>();
  command
      .add_option("recordings", arguments->recordings, "Recordings of one plant; with several, the last is only used to measure the result")
      ->required();
  command.add_option("--out", arguments->out, "Folder for diagnosis.json, report.html, effects.json (default: RECORDING-diagnosis)");
  command.add_option("--jobs", arguments->jobs, "Threads (default: one per core); the answer does not depend on it")
      ->check(CLI::Range(1, 1024));
  command.add_option("--candidates", arguments->candidates, "Only these effects, by id")->delimiter(',');
  command.add_option("--exclude", arguments->exclude, "All effects but these")->delimiter(',');
  command.add_option("--max-effects", arguments->max_effects, "Effects at once (default 2)")->check(CLI::Range(0, 2));
  command.add_option("--ignore-columns", arguments->ignore_columns, "Columns to skip, separated by commas")->delimiter(',');
  addModelOptions(command, model);
  command.remove_option(command.get_option("--json"));
  command.add_option("--json", arguments->json, "Write diagnosis.json also to FILE");
  return [&model, arguments] { return diagnoseCommand(model, *arguments); };
}

}  // namespace musclesim::program
