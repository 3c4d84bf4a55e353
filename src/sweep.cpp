/// `musclesim plan`, `work` and `collect`: parameter sweeps over many processes or machines.
#include "sweep/sweep.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "interrupt.h"
#include "musclesim/base/error.h"
#include "output_folder.h"
#include "sweep/collect.h"
#include "sweep/plan.h"
#include "sweep/work.h"

namespace musclesim::command_line {

namespace {

struct PlanArguments {
  std::string plan, folder;
  bool json = false;
};

int plan(const PlanArguments& arguments) {
  if (std::filesystem::exists(std::filesystem::path(arguments.folder) / "manifest.json"))
    throw BadParameter(arguments.folder + ": holds a sweep already; plan into another folder");
  makeFolder(arguments.folder);
  const Sweep sweep = readPlan(arguments.plan, arguments.folder);
  writeSweep(sweep, arguments.folder);
  if (arguments.json)
    fmt::print("{}\n",
               nlohmann::json{{"command", "plan"}, {"sweep", arguments.folder}, {"rows", sweep.rows.size()}, {"seed", sweep.seed}}.dump());
  else
    fmt::print("sweep   {}\nrows    {}\nseed    {}\n", arguments.folder, sweep.rows.size(), sweep.seed);
  return done;
}

struct WorkArguments {
  std::string folder;
  std::optional<double> time_limit_s, stale_after_s;
  bool no_wait = false, quiet = false, json = false;
};

nlohmann::json verdictOf(const WorkSummary& summary, const std::string& folder) {
  static const char* const ends[] = {"finished", "time limit", "interrupted"};
  return {{"command", "work"},
          {"sweep", folder},
          {"status", ends[static_cast<std::size_t>(summary.end)]},
          {"done", summary.done_count},
          {"diverged", summary.diverged_count},
          {"failed", summary.failed_count},
          {"crashed", summary.crashed_count},
          {"wall_s", summary.wall_s},
          {"child_wall_s", summary.child_wall_s}};
}

int workOnSweep(const WorkArguments& arguments) {
  WorkOptions options;
  for (const auto& [given, name, value] : {std::tuple(arguments.time_limit_s, "time-limit", &options.time_limit_s),
                                           std::tuple(arguments.stale_after_s, "stale-after", &options.stale_after_s)}) {
    if (!given) continue;
    if (!(*given > 0)) throw BadParameter(name, fmt::format("{} s", *given), "be positive");
    *value = *given;
  }
  options.wait = !arguments.no_wait;
  options.interrupt_signal = interruptSignal;
  if (!arguments.quiet) options.say = [](const std::string& message) { tell(message); };
  const WorkSummary summary = work(arguments.folder, options);
  const nlohmann::json verdict = verdictOf(summary, arguments.folder);
  options.say(fmt::format("{}: {} rows done, {} diverged, {} failed, {} crashed in {:.1f} s", verdict["status"].get<std::string>(),
                          summary.done_count, summary.diverged_count, summary.failed_count, summary.crashed_count, summary.wall_s));
  if (arguments.json) fmt::print("{}\n", verdict.dump());
  return summary.end == WorkSummary::End::interrupted ? interrupted_base + interruptSignal() : done;
}

struct CollectArguments {
  std::string folder;
  bool json = false;
};

void printRows(const char* what, const std::vector<std::size_t>& rows) {
  if (!rows.empty()) fmt::print("{:<9}{}: rows {}\n", what, rows.size(), fmt::join(rows, " "));
}

int collectSweep(const CollectArguments& arguments) {
  const Collected collected = collect(arguments.folder);
  if (arguments.json) {
    fmt::print("{}\n", nlohmann::json{{"command", "collect"},
                                      {"status", collected.complete() ? "done" : "incomplete"},
                                      {"rows", collected.row_count},
                                      {"done", collected.done_count},
                                      {"missing", collected.missing},
                                      {"diverged", collected.diverged},
                                      {"failed", collected.failed},
                                      {"crashed", collected.crashed},
                                      {"unmet_columns", collected.unmet_columns},
                                      {"csv", collected.csv_file},
                                      {"json", collected.json_file}}
                           .dump());
  } else {
    fmt::print("rows     {}\ndone     {}\n", collected.row_count, collected.done_count);
    printRows("missing", collected.missing);
    printRows("diverged", collected.diverged);
    printRows("failed", collected.failed);
    printRows("crashed", collected.crashed);
    fmt::print("table    {}\njson     {}\n", collected.csv_file, collected.json_file);
  }
  for (const std::string& column : collected.unmet_columns)
    fmt::print(stderr, "musclesim: columns: \"{}\": no row has a number of this name\n", column);
  if (!collected.complete()) return incomplete_sweep;
  return collected.unmet_columns.empty() ? done : bad_usage;
}

}  // namespace

Action addPlan(CLI::App& command) {
  auto arguments = std::make_shared<PlanArguments>();
  command.add_option("plan", arguments->plan, "TOML file with the command and its parameters: SWEEP.toml")->required();
  command.add_option("-o,--out", arguments->folder, "Folder of the sweep")->required();
  command.add_flag("--json", arguments->json, "Print JSON");
  return [arguments] { return plan(*arguments); };
}

Action addWork(CLI::App& command) {
  auto arguments = std::make_shared<WorkArguments>();
  command.add_option("sweep", arguments->folder, "Folder that `plan` wrote")->required();
  command.add_option("--time-limit", arguments->time_limit_s, "This worker stops within this wall time, in s (default: no limit)");
  command.add_option("--stale-after", arguments->stale_after_s,
                     "A worker on another machine counts as dead after this many s without a heartbeat (default 60)");
  command.add_flag("--no-wait", arguments->no_wait, "Exit when all rows are taken, without waiting to take over from a worker that dies");
  command.add_flag("--quiet", arguments->quiet, "No messages on standard error except errors");
  command.add_flag("--json", arguments->json, "Print a summary as one JSON object");
  return [arguments] { return workOnSweep(*arguments); };
}

Action addCollect(CLI::App& command) {
  auto arguments = std::make_shared<CollectArguments>();
  command.add_option("sweep", arguments->folder, "Folder that `plan` wrote")->required();
  command.add_flag("--json", arguments->json, "Print a summary as one JSON object");
  return [arguments] { return collectSweep(*arguments); };
}

}  // namespace musclesim::command_line
