#include "peers_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>
#include <limits>

#include "../peers/load.h"
#include "../peers/own.h"
#include "commands.h"
#include "interrupt.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/random.h"
#include "musclesim/base/units.h"
#include "musclesim/version.h"
#include "output_folder.h"
#include "peers_report.h"
#include "progress.h"

namespace musclesim::command_line {

namespace {

using peers::Peer;

constexpr double control_step_s = 0.01;
constexpr int hold_steps = 25;  ///< pressures hold for 0.25 s
constexpr int sequence_count = peer_sequence_count;
constexpr int early_step = 10, late_step = 30;
/// Steps per control step that are tried, and those of the converged path.
constexpr std::array tried = {1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 32, 50, 80, 125, 200};
constexpr int converged = 400;
constexpr const char* too_slow = "too slow";
constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double shortest_cpu_s = 0.1;  ///< short runs are repeated until they have taken this time

double cpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A robot that is moved, and how it is made with a number of steps per control step.
struct Contestant {
  std::string engine, version, method;
  std::function<std::unique_ptr<Peer>(int substeps)> make;
};

/// One sequence of random pressures from the pose as built.
struct Path {
  Vector early_m = Vector::Constant(std::nan("")), late_m = early_m;
  double gap_m = 0, cpu_s = 0;
  std::string failure;
};

/// Moves a robot until the later of the two times, or until it has used so much CPU time.
Path follow(const Contestant& contestant, int substeps, int muscle_count, int sequence, double time_limit_s) {
  Path path;
  RandomStream random(static_cast<std::uint64_t>(sequence), "bench.pressures");
  musclesim::Action command(static_cast<std::size_t>(muscle_count));
  try {
    const std::unique_ptr<Peer> peer = contestant.make(substeps);
    for (int i = 0; i < late_step; ++i) {
      if (i % hold_steps == 0)
        for (double& pressure : command) pressure = random.uniform();
      const double begin = cpuSeconds();
      peer->advance(command, substeps);
      path.cpu_s += cpuSeconds() - begin;
      path.gap_m = std::max(path.gap_m, peer->gapM());
      if (i + 1 == early_step) path.early_m = peer->handM();
      if (path.cpu_s > time_limit_s) {
        path.failure = too_slow;
        return path;
      }
    }
    path.late_m = peer->handM();
    if (!path.late_m.allFinite()) path.failure = "diverged";
  } catch (const Error& error) {
    path.failure = error.what();
  }
  return path;
}

/// The same with every sequence, or until `enough` says so or a run is too slow.
std::vector<Path> followAll(const Contestant& contestant, int substeps, int muscle_count, double time_limit_s,
                            const std::function<bool(const std::vector<Path>&)>& enough = {}) {
  std::vector<Path> paths;
  for (int sequence = 1; sequence <= sequence_count && !interruptSignal(); ++sequence) {
    paths.push_back(follow(contestant, substeps, muscle_count, sequence, time_limit_s));
    if (paths.back().failure == too_slow || (enough && enough(paths))) break;
  }
  return paths;
}

bool isTooSlow(const std::vector<Path>& paths) {
  return paths.empty() || paths.back().failure == too_slow;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// Medians over the sequences. One that failed, and one that was not run any more, is infinitely far off.
struct Accuracy {
  double early_mm, late_mm, gap_mm;
};

Accuracy accuracyOf(const std::vector<Path>& paths, const std::vector<Path>& reference, double not_run_mm = unlimited) {
  std::vector<double> early_mm(sequence_count, not_run_mm), late_mm = early_mm, gap_mm = early_mm;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const bool whole = paths[i].failure.empty() && reference[i].failure.empty();
    const auto valueOf = [whole](double value_m) { return whole ? value_m * mm_per_m : unlimited; };
    early_mm[i] = valueOf((paths[i].early_m - reference[i].early_m).norm());
    late_mm[i] = valueOf((paths[i].late_m - reference[i].late_m).norm());
    gap_mm[i] = valueOf(paths[i].gap_m);
  }
  return {median(early_mm), median(late_mm), median(gap_mm)};
}

double cpuSecondsOf(const std::vector<Path>& paths) {
  double sum = 0;
  for (const Path& path : paths) sum += path.cpu_s;
  return sum / static_cast<double>(paths.size());
}

bool keepsRule(const Accuracy& accuracy, PeerRule rule) {
  return accuracy.early_mm <= peer_rule_hand_mm && accuracy.gap_mm <= peer_rule_gap_mm &&
         (rule == PeerRule::early || accuracy.late_mm <= peer_rule_hand_mm);
}

/// The longest step of a method that keeps the rule together with the next shorter one; none if a run gets slower than `time_limit_s`.
struct Choice {
  const Contestant* contestant = nullptr;
  int substeps = 0;
  Accuracy accuracy = {};
  double cpu_s = 0;
};

/// An engine with one robot: its converged paths, and its choice among its methods.
struct Entry {
  PeerResult result;
  std::vector<Contestant> methods;
  std::vector<Path> reference;
  Choice choice;
  std::vector<double> cpu_s;  ///< of each turn
};

Choice longestStep(const Contestant& contestant, const Entry& entry, double time_limit_s) {
  Choice last;
  for (const int substeps : tried) {
    // Enough is known once the rule is broken even if all other sequences were without any error.
    const std::vector<Path> paths = followAll(
        contestant, substeps, entry.result.muscle_count, time_limit_s,
        [&entry](const std::vector<Path>& so_far) { return !keepsRule(accuracyOf(so_far, entry.reference, 0), entry.result.rule); });
    if (isTooSlow(paths)) return {};
    const Accuracy accuracy = accuracyOf(paths, entry.reference);
    const bool keeps = keepsRule(accuracy, entry.result.rule);
    if (keeps && last.contestant) return last;
    last = keeps ? Choice{&contestant, substeps, accuracy, cpuSecondsOf(paths)} : Choice{};
  }
  return {};
}

void choose(Entry& entry, double time_limit_s) {
  double limit_s = time_limit_s;
  for (const Contestant& method : entry.methods) {
    const Choice choice = longestStep(method, entry, limit_s);
    if (!choice.contestant || choice.cpu_s >= limit_s) continue;
    limit_s = choice.cpu_s;
    entry.choice = choice;
  }
  PeerResult& r = entry.result;
  if (!entry.choice.contestant) {
    r.failure = fmt::format("no step down to {:g} ms keeps the rule in time", control_step_s * ms_per_s / tried.back());
    return;
  }
  r.method = entry.choice.contestant->method;
  r.step_ms = control_step_s * ms_per_s / entry.choice.substeps;
  r.early_mm = entry.choice.accuracy.early_mm;
  r.late_mm = entry.choice.accuracy.late_mm;
  r.gap_mm = entry.choice.accuracy.gap_mm;
}

void converge(Entry& entry, double time_limit_s) {
  entry.reference = followAll(entry.methods.front(), converged, entry.result.muscle_count, time_limit_s);
  for (const Path& path : entry.reference)
    if (!path.failure.empty()) entry.result.failure = "converged path: " + path.failure;
}

/// Where musclesim itself cannot keep the rule with any step, that at the earlier time alone counts, for all engines.
void chooseAll(std::vector<Entry>& entries, double time_limit_s) {
  PeerRule rule = PeerRule::early_and_late;
  for (Entry& entry : entries) {
    if (!entry.result.failure.empty()) continue;
    converge(entry, time_limit_s);
    if (!entry.result.failure.empty()) continue;
    entry.result.rule = rule;
    choose(entry, time_limit_s);
    if (&entry != &entries.front() || entry.result.failure.empty()) continue;
    entry.result.failure.clear();
    entry.result.rule = rule = PeerRule::early;
    choose(entry, time_limit_s);
  }
}

SimulationOptions optionsOf(int muscle_count, bool chains, int substeps) {
  SimulationOptions options;
  options.step_s = control_step_s;
  options.substeps = substeps;
  options.parameters.set("arm.muscle_count", static_cast<double>(muscle_count), "bench");
  options.parameters.set("physics.contacts", "off", "bench");
  options.parameters.set("muscle.model", chains ? "chain" : "line", "bench");
  return options;
}

/// The arm, as the other engines read it.
struct Arm {
  Arm(int muscle_count, bool chains) : simulation(optionsOf(muscle_count, chains, 0)) {
    simulation.build("arm");
    mechanism = peers::mechanismOf(simulation);
    tree = peers::spanningTree(mechanism);
  }
  Simulation simulation;
  peers::Mechanism mechanism;
  peers::Tree tree;
};

std::vector<Entry> entriesOf(const Arm& arm, int muscle_count, bool chains) {
  std::vector<Entry> entries;
  const auto add = [&](const std::string& engine, const std::string& version) -> Entry& {
    Entry& entry = entries.emplace_back();
    entry.result.engine = engine;
    entry.result.version = version;
    entry.result.muscle_count = muscle_count;
    entry.result.chains = chains;
    return entry;
  };
  add("musclesim", MUSCLESIM_VERSION).methods.push_back({"musclesim", "", "chain stepper", [=](int substeps) {
                                                           return std::make_unique<peers::OwnPeer>(
                                                               optionsOf(muscle_count, chains, substeps), "arm");
                                                         }});
  for (const peers::LoadedEngine& loaded : peers::loadEngines()) {
    Entry& entry = add(loaded.name, loaded.engine ? loaded.engine->version : "");
    entry.result.failure = loaded.reason;
    if (!loaded.engine) continue;
    for (const std::string& method : loaded.engine->methods)
      entry.methods.push_back({loaded.name, loaded.engine->version, method, [&arm, method, make = loaded.engine->make](int substeps) {
                                 return make(arm.mechanism, arm.tree, {method, control_step_s / substeps});
                               }});
  }
  return entries;
}

/// CPU time of the chosen runs, per sequence; short ones are repeated.
double timed(const Choice& choice, int muscle_count) {
  double cpu_s = 0;
  int count = 0;
  for (; cpu_s < shortest_cpu_s; count += sequence_count)
    for (int sequence = 1; sequence <= sequence_count; ++sequence)
      cpu_s += follow(*choice.contestant, choice.substeps, muscle_count, sequence, unlimited).cpu_s;
  return cpu_s / count;
}

void compare(Entry& entry, const Entry& ours) {
  PeerResult& r = entry.result;
  r.ratio = median(entry.cpu_s) / peer_rule_late_s;
  if (ours.cpu_s.size() != entry.cpu_s.size()) return;
  std::vector<double> over_ours;
  for (std::size_t i = 0; i < entry.cpu_s.size(); ++i) over_ours.push_back(entry.cpu_s[i] / ours.cpu_s[i]);
  r.over_ours = median(over_ours);
  r.step_over_ours = r.over_ours * r.step_ms / ours.result.step_ms;
  r.least = *std::ranges::min_element(over_ours);
  r.largest = *std::ranges::max_element(over_ours);
  const Accuracy beside_ours = accuracyOf(entry.reference, ours.reference);
  r.early_from_ours_mm = beside_ours.early_mm;
  r.late_from_ours_mm = beside_ours.late_mm;
}

/// All engines run in turn.
void measure(std::vector<Entry>& entries, int repeat_count) {
  for (int repeat = 0; repeat < repeat_count; ++repeat)
    for (Entry& entry : entries)
      if (entry.result.failure.empty() && !interruptSignal()) entry.cpu_s.push_back(timed(entry.choice, entry.result.muscle_count));
  for (Entry& entry : entries)
    if (entry.cpu_s.size() == static_cast<std::size_t>(repeat_count)) compare(entry, entries.front());
}

void write(const std::vector<PeerResult>& results, const ModelOptions& model, const PeersBenchArguments& arguments) {
  const std::filesystem::path folder = outputFolder(arguments.out, "bench");
  makeFolder(folder / "figures");
  const std::string page = (folder / "performance.md").string(), figure = (folder / "figures" / "peers.svg").string();
  const std::string section = peersSection(results, arguments.repeat_count, arguments.time_limit_s);
  replaceFile(page, withPeersSection(existingPage(folder), section));
  replaceFile(figure, peersFigure(results));
  fmt::print("{}\ntable   {}\nfigure  {}\n", section, page, figure);
  if (model.json) fmt::print("{}\n", peersJson(results).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

std::string existingPage(const std::filesystem::path& folder) {
  const std::filesystem::path page = folder / "performance.md";
  constexpr std::size_t largest_bytes = 1 << 20;
  return std::filesystem::exists(page) ? readTextFile(page.string(), largest_bytes) : "";
}

int benchPeers(const ModelOptions& model, const PeersBenchArguments& arguments) {
  std::vector<PeerResult> results;
  CaseProgress progress(model.quiet);
  int done_count = 0;
  const int case_count = static_cast<int>(2 * arguments.muscle_counts.size());
  for (const bool chains : {true, false})
    for (const int muscle_count : arguments.muscle_counts) {
      const Arm arm(muscle_count, chains);
      std::vector<Entry> entries = entriesOf(arm, muscle_count, chains);
      chooseAll(entries, arguments.time_limit_s);
      if (!interruptSignal()) measure(entries, arguments.repeat_count);
      if (interruptSignal()) return interrupted_base + interruptSignal();
      for (const Entry& entry : entries) results.push_back(entry.result);
      progress.show(++done_count, case_count);
    }
  write(results, model, arguments);
  return done;
}

}  // namespace musclesim::command_line
