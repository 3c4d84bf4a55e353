/// `musclesim bench`: real-time ratio r(n) over the number of muscles, per stepper and muscle model, in one run (the paper's Figure 9);
/// with --peers the comparison with other engines.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench_report.h"
#include "commands.h"
#include "interrupt.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/random.h"
#include "musclesim/base/units.h"
#include "output_folder.h"
#include "peers_bench.h"
#include "peers_report.h"
#include "progress.h"

namespace musclesim::command_line {

namespace {

struct BenchArguments {
  double duration_s = 2;
  std::optional<double> time_limit_s;
  int repeat_count = 3;
  std::vector<int> muscle_counts;
  std::optional<std::string> out;
  bool peers = false;
};

const std::vector<int> muscle_counts = {1, 2, 5, 10, 15, 20, 25, 30}, muscle_counts_of_peers = {1, 5, 10, 30};
constexpr double time_limit_s = 5, time_limit_of_peers_s = 20;

constexpr double shortest_cpu_s =
    0.1;  ///< fast runs are extended to this time, so that their first, slower steps (cold caches) do not matter

/// A configuration to measure: one line of the figure.
struct Candidate {
  std::string name;
  PhysicsKind physics;
  StepperKind stepper;
  std::vector<std::string> parameters;
};

std::vector<Candidate> candidates() {
  std::vector<Candidate> all;
  for (const PhysicsKind physics : {PhysicsKind::original, PhysicsKind::si}) {
    const std::string kind = nameOf(physics);
    all.push_back({kind + ", dWorldStep", physics, StepperKind::ode, {}});
    all.push_back({kind + ", dWorldQuickStep", physics, StepperKind::quick, {}});
    all.push_back({kind + ", chain stepper", physics, StepperKind::automatic, {}});
    all.push_back({kind + ", chain stepper, no contacts", physics, StepperKind::automatic, {"physics.contacts=off"}});
    all.push_back({kind + ", chain stepper, viscous, no contacts",
                   physics,
                   StepperKind::automatic,
                   {"physics.contacts=off", "muscle.joint_friction=viscous"}});
    all.push_back({kind + ", line muscles", physics, StepperKind::automatic, {"muscle.model=line"}});
  }
  return all;
}

double cpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Measures CPU time over simulated time of one run under random pressures, which change every 0.25 s of true time. The run ends after the
/// duration, but not before shortest_cpu_s; it ends early after the control step in which it passes the time limit.
BenchRun measure(const Candidate& candidate, int muscle_count, const BenchArguments& arguments) {
  SimulationOptions options;
  options.physics = candidate.physics;
  options.stepper = candidate.stepper;
  options.parameters.set("arm.muscle_count", static_cast<double>(muscle_count), "bench");
  for (const auto& assignment : candidate.parameters) options.parameters.setFromText(assignment, "bench");
  Simulation simulation(std::move(options));
  Robot& robot = simulation.build("arm");
  const double slowness = candidate.physics == PhysicsKind::original ? std::sqrt(original_force_deficit_ratio) : 1;
  const double duration_s = arguments.duration_s * slowness;
  const long hold = std::max(1L, std::lround(0.25 * slowness / simulation.stepS()));
  RandomStream random(1, "bench.pressures");
  musclesim::Action command(static_cast<std::size_t>(muscle_count));
  BenchRun run;
  run.muscle_count = muscle_count;
  const double begin = cpuSeconds();
  const auto goesOn = [&] {
    const double cpu_s = cpuSeconds() - begin;
    return (simulation.time_s() < duration_s - 1e-9 || cpu_s < shortest_cpu_s) && cpu_s < *arguments.time_limit_s;
  };
  try {
    for (long i = 0; goesOn(); ++i) {
      if (i % hold == 0)
        for (double& pressure : command) pressure = random.uniform();
      robot.step(command);
      simulation.step();
      run.contact_count = std::max(run.contact_count, simulation.contactCount());
    }
  } catch (const Diverged&) {
    run.diverged = true;
  }
  run.simulated_s = simulation.time_s();
  run.ratio = run.simulated_s > 0 ? (cpuSeconds() - begin) / run.simulated_s : std::nan("");
  run.gap_mm = simulation.worstGap().gap_mm;
  run.substeps = simulation.substeps();
  run.cut_short = !run.diverged && run.simulated_s < duration_s - 1e-9;
  return run;
}

/// The run with the median ratio among the repeats.
BenchRun median(std::vector<BenchRun> runs) {
  std::sort(runs.begin(), runs.end(), [](const BenchRun& a, const BenchRun& b) { return a.ratio < b.ratio; });
  BenchRun result = runs[runs.size() / 2];
  result.repeat_count = static_cast<int>(runs.size());
  result.spread = runs.back().ratio / runs.front().ratio;
  return result;
}

int bench(const ModelOptions& model, BenchArguments arguments) {
  if (arguments.muscle_counts.empty()) arguments.muscle_counts = arguments.peers ? muscle_counts_of_peers : muscle_counts;
  if (!arguments.time_limit_s) arguments.time_limit_s = arguments.peers ? time_limit_of_peers_s : time_limit_s;
  if (!(arguments.duration_s >= 0.05)) throw BadParameter("duration", fmt::format("{} s", arguments.duration_s), "be at least 0.05 s");
  if (arguments.repeat_count < 1) throw BadParameter("repeats", fmt::format("{}", arguments.repeat_count), "be at least 1");
  if (arguments.peers) return benchPeers(model, {arguments.muscle_counts, arguments.repeat_count, *arguments.time_limit_s, arguments.out});
  const std::vector<Candidate> all = candidates();
  std::vector<std::vector<std::vector<BenchRun>>> runs(all.size());  // by candidate, number of muscles, repeat
  for (auto& of_candidate : runs) of_candidate.resize(arguments.muscle_counts.size());
  const int all_count = arguments.repeat_count * static_cast<int>(arguments.muscle_counts.size() * all.size());
  int done_count = 0;
  CaseProgress progress(model.quiet);
  // Each repeat measures everything once, so that other load on the machine for a while disturbs only one repeat of each point.
  for (int repeat = 0; repeat < arguments.repeat_count; ++repeat)
    for (std::size_t n = 0; n < arguments.muscle_counts.size(); ++n)
      for (std::size_t c = 0; c < all.size(); ++c) {
        ++done_count;
        if (repeat > 0 && runs[c][n].back().cut_short) continue;  // too slow to be repeated
        runs[c][n].push_back(measure(all[c], arguments.muscle_counts[n], arguments));
        if (interruptSignal()) return interrupted_base + interruptSignal();
        progress.show(done_count, all_count);
      }
  std::vector<BenchCurve> curves;
  for (std::size_t c = 0; c < all.size(); ++c) {
    curves.push_back({all[c].name, {}});
    for (const auto& repeats : runs[c]) curves.back().runs.push_back(median(repeats));
  }
  const std::filesystem::path folder = outputFolder(arguments.out, "bench");
  makeFolder(folder / "figures");
  const std::string table = benchTable(curves, arguments.duration_s, shortest_cpu_s, *arguments.time_limit_s);
  const std::string peers = peersSectionOf(existingPage(folder));
  replaceFile((folder / "performance.md").string(), peers.empty() ? table : withPeersSection(table, peers));
  replaceFile((folder / "figures" / "performance.svg").string(), benchFigure(curves));
  fmt::print("{}\ntable   {}\nfigure  {}\n", table, (folder / "performance.md").string(),
             (folder / "figures" / "performance.svg").string());
  if (model.json) fmt::print("{}\n", benchJson(curves).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  return done;
}

}  // namespace

Action addBench(CLI::App& command, ModelOptions& model) {
  auto arguments = std::make_shared<BenchArguments>();
  command.add_flag(
      "--peers", arguments->peers,
      "Instead: the same arm in MuJoCo, Simbody and Bullet, as far as they were installed when musclesim was built, each at its best step");
  command.add_option("--duration", arguments->duration_s, "Simulated time per run, in true s; without --peers")->capture_default_str();
  command.add_option("--time-limit", arguments->time_limit_s,
                     fmt::format("A run that has used this much CPU time, in s, is cut short (default: {:g}, with --peers {:g})",
                                 time_limit_s, time_limit_of_peers_s));
  command.add_option("--repeats", arguments->repeat_count, "Number of runs per point; the report gives their median")
      ->capture_default_str();
  command
      .add_option("--muscles", arguments->muscle_counts,
                  fmt::format("Numbers of muscles, separated by commas (default: {}, with --peers {})", fmt::join(muscle_counts, ","),
                              fmt::join(muscle_counts_of_peers, ",")))
      ->delimiter(',');
  command.add_option(
      "--out", arguments->out,
      "Folder for performance.md and figures (default: log/runs/<date-time>-bench); a page that is there keeps what the other "
      "of the two kinds of comparison wrote");
  command.add_flag("--quiet", model.quiet, "No messages on standard error except errors");
  command.add_flag("--json", model.json, "Print the results as one JSON object, the last line of standard output");
  return [&model, arguments] { return bench(model, *arguments); };
}

}  // namespace musclesim::command_line
