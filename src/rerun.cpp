/// `musclesim rerun`: repeats a run from what its folder holds and compares the bytes.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "interrupt.h"
#include "json_differences.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/json_document.h"
#include "musclesim/base/text.h"
#include "musclesim/base/unique_name.h"
#include "musclesim/log/csv.h"
#include "musclesim/version.h"
#include "output_folder.h"
#include "plugin.h"
#include "program_build.h"
#include "run.h"
#include "run_origin.h"

namespace musclesim::command_line {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct RerunArguments {
  std::string folder;
  std::optional<std::string> out;
  std::vector<std::string> plugins;
  bool json = false, quiet = false;
};

/// What a repetition came to.
struct Comparison {
  bool is_same = false;
  std::string finding;                   ///< of the table of readings
  std::vector<std::string> differences;  ///< of what the readings depend on
};

/// A folder for the repetition. One that nobody named is removed at the end.
class OutputFolder {
 public:
  explicit OutputFolder(const std::optional<std::string>& given)
      : path_(given ? fs::path(*given) : fs::temp_directory_path() / ("musclesim_rerun_" + uniqueName())), is_kept_(given.has_value()) {
    makeFolder(path_);
  }
  ~OutputFolder() {
    std::error_code ignored;
    if (!is_kept_) fs::remove_all(path_, ignored);
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  fs::path csv() const { return path_ / "run.csv"; }

 private:
  fs::path path_;
  bool is_kept_;
};

/// The recording in a folder: run.csv, or the file itself.
fs::path recordingIn(const std::string& folder) {
  if (folder.ends_with(".csv")) return folder;
  const fs::path csv = fs::path(folder) / "run.csv";
  if (!fs::exists(csv)) throw BadFile(folder, "has no run.csv: name the folder of a run, or its recording");
  return csv;
}

/// The options that the run was given, with the copies of its input files in place of the files. A plugin is code, so none is loaded unless
/// the user of `rerun` names it.
class StoredRun {
 public:
  StoredRun(const RunOrigin& origin, const fs::path& csv) : sidecar_(sidecarPath(csv.string())) {
    CLI::App app;
    addRunOptions(app, options_);
    addModelOptions(app, model_);
    app.remove_option(app.get_option(plugin_option));
    app.add_option(plugin_option, plugins_)->take_all();
    std::vector<std::string> words = argumentsWithCopies(origin, csv.parent_path(), sidecar_);
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    try {
      app.parse(std::move(words));
    } catch (const CLI::ParseError& error) {
      throw BadFile(sidecar_, fmt::format("run: this program does not understand the arguments: {}", error.what()));
    }
    requireKept(origin, csv.parent_path());
  }

  bool hadWindow() const { return hasWindow(options_); }
  const std::vector<std::string>& plugins() const { return plugins_; }

  /// Repeats the run until the time of its last row. Returns its exit status.
  int repeat(const fs::path& csv, double duration_s) {
    options_.simple = options_.only_record = options_.overwrite = true;
    options_.verbose = options_.print_config = false;
    options_.pictures = {};
    options_.window_log.reset();
    options_.against.reset();
    options_.out.reset();
    options_.record = csv.string();
    options_.duration_s = duration_s;
    model_.quiet = true;
    return run(model_, options_);
  }

 private:
  /// No file but the copies is read: the arguments may come from anywhere.
  void requireKept(const RunOrigin& origin, const fs::path& folder) const {
    for (const KeptFile& named : namedFiles(model_, options_)) {
      const bool is_copy = std::ranges::any_of(origin.files, [&](const KeptFile& kept) {
        return kept.copy && (folder / *kept.copy).lexically_normal() == fs::path(named.given);
      });
      if (!is_copy) throw BadFile(sidecar_, fmt::format("run: the folder has no copy of {} {}", named.option, named.given));
    }
  }

  std::string sidecar_;
  ModelOptions model_;
  RunOptions options_;
  std::vector<std::string> plugins_;
};

json sidecarOf(const fs::path& csv) {
  constexpr std::size_t limit_bytes = std::size_t{64} << 20;
  const std::string file = sidecarPath(csv.string());
  return JsonDocument(readTextFile(file, limit_bytes), file).root();
}

std::string tableOf(const fs::path& csv) {
  return readTextFile(csv.string(), CsvLimits().file_bytes);
}

/// Members of the sidecar that say nothing of the model, or are compared in other ways.
bool isOfTheModel(const std::string& member) {
  static const std::vector<std::string> others = {"format",     "robot",       "program", "complete",   "verdict", "run",      "by_hand_s",
                                                  "robot_hash", "description", "trial",   "controller", "task",    "repeat_of"};
  return std::ranges::find(others, member) == others.end();
}

json ofTheModel(const json& sidecar) {
  json model = json::object();
  for (const auto& [member, value] : sidecar.items())
    if (isOfTheModel(member)) model[member] = value;
  return model;
}

/// Version and build of the program, of ODE and of the C library, and the processor.
void addProgramDifferences(const json& recorded, const RunOrigin* origin, std::vector<std::string>& differences) {
  const std::string version = "musclesim " MUSCLESIM_VERSION, recorded_version = recorded.value("program", "");
  if (recorded_version != version)
    differences.push_back(fmt::format("program: {} made the recording, this is {}", recorded_version, version));
  if (!origin) return;
  const auto build = programBuild();
  for (const auto& [name, id] : origin->build) {
    const auto now = build.find(name);
    if (now == build.end() || now->second != id)
      differences.push_back(fmt::format("{}: {} made the recording, this is {}", name == "processor" ? name : "build of " + name, id,
                                        now == build.end() ? "another" : now->second));
  }
}

/// Files that are no longer those of the run.
void addFileDifferences(const RunOrigin& origin, const fs::path& folder, const RerunArguments& arguments,
                        std::vector<std::string>& differences) {
  for (const KeptFile& file : origin.files)
    if (file.copy && hashOfFile(folder / *file.copy) != file.hash)
      differences.push_back(fmt::format("{}: {} is not the file of the run: its text has changed", file.option, *file.copy));
  for (const std::string& plugin : arguments.plugins)
    if (std::ranges::none_of(origin.files,
                             [&](const KeptFile& file) { return file.option == plugin_option && file.hash == hashOfFile(plugin); }))
      differences.push_back(fmt::format("--plugin: {} is none of the run's plugins", plugin));
}

void requirePlugins(const RunOrigin& origin, const RerunArguments& arguments) {
  std::vector<std::string> needed;
  for (const KeptFile& file : origin.files)
    if (file.option == plugin_option) needed.push_back(file.given);
  if (arguments.plugins.size() < needed.size())
    throw BadParameter(fmt::format("the run used plugins, which are code and so not run unasked: give them again: --plugin {}",
                                   fmt::join(needed, " --plugin ")));
  std::ranges::for_each(arguments.plugins, loadPlugin);
}

/// The first line in which two tables differ, counted from 1.
std::size_t firstOtherLine(const std::string& a, const std::string& b) {
  const auto place = std::ranges::mismatch(a, b).in1;
  return 1 + static_cast<std::size_t>(std::count(a.begin(), place, '\n'));
}

void compareTables(const fs::path& csv, const fs::path& repeated_csv, Comparison& comparison) {
  std::string recorded = tableOf(csv);
  recorded.erase(recorded.rfind('\n') + 1);  // the last line of a killed run may be cut
  const std::string repeated = tableOf(repeated_csv);
  comparison.is_same = recorded == repeated;
  comparison.finding = comparison.is_same ? fmt::format("the same {} bytes", recorded.size())
                                          : fmt::format("other bytes, from line {} on", firstOtherLine(recorded, repeated));
}

/// The readings alone: a controller's targets and activity do not come from the commands.
void compareReadings(const Recording& recorded, const Recording& repeated, Comparison& comparison) {
  std::vector<std::string> other, left_out;
  std::size_t same_count = 0;
  for (const Signal& signal : recorded.signals) {
    const Signal* again = repeated.find(signal.name);
    if (!again)
      left_out.push_back(signal.name);
    else if (std::ranges::equal(signal.values, again->values, [](double a, double b) {
               return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
             }))
      ++same_count;
    else
      other.push_back(signal.name);
  }
  comparison.is_same = other.empty() && same_count > 0;
  comparison.finding = comparison.is_same ? fmt::format("the same bits in {} columns", same_count)
                                          : fmt::format("other bits in {} of {} columns: {}", other.size(), other.size() + same_count,
                                                        fmt::join(other, ", "));
  if (!left_out.empty()) comparison.finding += fmt::format("; not repeated: {}", fmt::join(left_out, ", "));
}

Comparison replayed(const Recording& recording, const json& sidecar, const OutputFolder& out) {
  ReplayOptions options;
  options.stepper = stepperFromName(sidecar.value("stepper", "auto"));
  options.interrupted = [] { return interruptSignal() != 0; };
  const ReplayResult result = replayRecording(recording, options);
  if (result.interrupted) throw Interrupted("the repetition was interrupted");
  writeRecording(result.simulated, out.csv().string());
  Comparison comparison;
  compareReadings(recording, result.simulated, comparison);
  return comparison;
}

/// Whether only the commands can be repeated, and why; empty if the whole run can.
std::string whyOnlyCommands(const json& sidecar, const StoredRun* stored) {
  if (!stored) return "the folder does not say how the run was made";
  const json hands = sidecar.value("by_hand_s", json());
  if (hands.is_array() && !hands.empty()) return "the user controlled muscles by hand";
  if (stored->hadWindow() && !sidecar.contains("verdict"))
    return "the window's run was killed, so that it is not known what was done by hand";
  return "";
}

void report(const fs::path& csv, const Comparison& comparison, const RerunArguments& arguments) {
  fmt::print("{}  {}\n", printable(csv.string()), comparison.finding);
  for (const std::string& difference : comparison.differences) fmt::print("differs  {}\n", printable(difference));
  if (!comparison.is_same && comparison.differences.empty())
    fmt::print("differs  nothing that the folder names: the table itself was changed, or the program is at fault\n");
  if (!arguments.json) return;
  fmt::print("{}\n", json{{"command", "rerun"},
                          {"recording", csv.string()},
                          {"status", comparison.is_same ? "same" : "different"},
                          {"finding", comparison.finding},
                          {"differences", comparison.differences}}
                         .dump(-1, ' ', false, json::error_handler_t::replace));
}

int rerun(const RerunArguments& arguments) {
  const fs::path csv = recordingIn(arguments.folder);
  const Recording recording = readRecording(csv.string());
  if (recording.time_s.size() < 2) throw BadFile(csv.string(), "has no second row, so there is nothing to repeat");
  const json sidecar = sidecarOf(csv);
  std::optional<RunOrigin> origin;
  std::unique_ptr<StoredRun> stored;
  if (sidecar.contains("run")) {
    origin = originFromJson(sidecar["run"], sidecarPath(csv.string()));
    requirePlugins(*origin, arguments);
    stored = std::make_unique<StoredRun>(*origin, csv);
  }
  const OutputFolder out(arguments.out);
  requireOther(out.csv(), {csv.string()});
  Comparison comparison;
  if (const std::string why = whyOnlyCommands(sidecar, stored.get()); !why.empty()) {
    if (!arguments.quiet) tell("only the commands are repeated: " + why);
    comparison = replayed(recording, sidecar, out);
  } else {
    const int status = stored->repeat(out.csv(), recording.time_s.back());
    if (status > interrupted_base) return status;
    compareTables(csv, out.csv(), comparison);
    for (const auto& [name, before, now] : differencesOf(ofTheModel(sidecar), ofTheModel(sidecarOf(out.csv()))))
      comparison.differences.push_back(fmt::format("{}: {} was recorded, {} is what the repetition has", name, before, now));
  }
  addProgramDifferences(sidecar, origin ? &*origin : nullptr, comparison.differences);
  if (origin) addFileDifferences(*origin, csv.parent_path(), arguments, comparison.differences);
  report(csv, comparison, arguments);
  return comparison.is_same ? done : bad_input;
}

}  // namespace

Action addRerun(CLI::App& command) {
  auto arguments = std::make_shared<RerunArguments>();
  command.add_option("folder", arguments->folder, "Folder of a run, or its recording NAME.csv")->required();
  command.add_option("--out", arguments->out, "Folder in which the repetition is kept (default: it is removed)");
  command.add_option(plugin_option, arguments->plugins, "Plugin of the run, LIBRARY.so; code in a folder is not run unasked")->take_all();
  command.add_flag("--quiet", arguments->quiet, "No messages on standard error except errors");
  command.add_flag("--json", arguments->json, "Print the verdict as one JSON object, the last line of standard output");
  return [arguments] { return rerun(*arguments); };
}

}  // namespace musclesim::command_line
