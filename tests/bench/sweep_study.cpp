/// Checks that a disturbed sweep ends with the same table as an undisturbed one, and that two workers do twice the work of one.
///
/// Usage: sweep_study PROGRAM [rows = 500] [seed = 1]
/// Runs the same short runs three times: with one worker, with two, and with two while a tenth of the runs is killed (SIGKILL) at random
/// instants and one worker is killed in the middle of a row. Prints what happened; exit status 1 if a table differs.
#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <thread>

#include "musclesim/base/random.h"
#include "sweep/collect.h"
#include "sweep/plan.h"
#include "sweep/sweep.h"
#include "sweep/work.h"

namespace fs = std::filesystem;
using namespace musclesim;

namespace {

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string planText(int row_count) {
  return fmt::format(R"(format = "musclesim-sweep-1"
command = ["run", "--simple", "--robot", "rig", "--controller", "random", "--duration", "2", "--seed", "{{seed}}", "--out", "{{out}}",
           "--record-interval", "0.1", "--json", "--quiet"]
seed = 11
[latin_hypercube]
count = {}
rig.load_kg = {{low = 1, high = 20, log = true}}
)",
                     row_count);
}

struct Cost {
  double wall_s = 0, cpu_s = 0;
};

double cpuOfChildrenS() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Runs workers on a sweep, each in its own process. `disturb` is called repeatedly with the living workers.
Cost workOn(const std::string& program, const std::string& sweep, int worker_count,
            const std::function<void(const std::vector<pid_t>&)>& disturb = {}) {
  const auto begin = std::chrono::steady_clock::now();
  const double cpu_begin_s = cpuOfChildrenS();
  std::vector<pid_t> workers;
  for (int i = 0; i < worker_count; ++i) {
    workers.push_back(fork());
    if (workers.back() == 0) {
      execl(program.c_str(), program.c_str(), "work", sweep.c_str(), "--quiet", nullptr);
      _exit(127);
    }
  }
  while (!workers.empty()) {
    if (disturb) disturb(workers);
    std::erase_if(workers, [&](pid_t worker) { return waitpid(worker, nullptr, disturb ? WNOHANG : 0) == worker; });
    if (disturb) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), cpuOfChildrenS() - cpu_begin_s};
}

/// Kills runs and one worker.
class Killer {
 public:
  Killer(int row_count, std::uint64_t seed) : row_count_(row_count), random_(seed, "sweep_study.killer") {}

  void disturb(const std::vector<pid_t>& workers) {
    for (const pid_t worker : workers) {
      pid_t run = 0;
      if (!(std::istringstream(contentOf(fmt::format("/proc/{0}/task/{0}/children", worker))) >> run)) continue;
      meet(run, worker, workers.size() > 1);
    }
    const auto now = std::chrono::steady_clock::now();
    std::erase_if(doomed_, [&](const Doomed& doomed) {
      if (now < doomed.when) return false;
      const bool exists = kill(doomed.pid, SIGKILL) == 0;
      (doomed.is_worker ? killed_workers_ : killed_runs_) += exists;
      return true;
    });
  }

  int seenRuns() const { return static_cast<int>(seen_.size()); }
  int killedRuns() const { return killed_runs_; }
  int killedWorkers() const { return killed_workers_; }

 private:
  struct Doomed {
    pid_t pid;
    bool is_worker;
    std::chrono::steady_clock::time_point when;
  };

  void meet(pid_t run, pid_t worker, bool may_kill_worker) {
    if (!seen_.insert(run).second) return;
    constexpr double longest_wait_ms = 25;
    const auto when =
        std::chrono::steady_clock::now() + std::chrono::microseconds(static_cast<long>(1000 * random_.uniform(0, longest_wait_ms)));
    if (may_kill_worker && !worker_doomed_ && seenRuns() > row_count_ / 3) {
      worker_doomed_ = true;
      doomed_.push_back({worker, true, when});
    } else if (random_.uniform() < 0.1) {
      doomed_.push_back({run, false, when});
    }
  }

  int row_count_;
  RandomStream random_;
  std::set<pid_t> seen_;
  std::vector<Doomed> doomed_;
  bool worker_doomed_ = false;
  int killed_runs_ = 0, killed_workers_ = 0;
};

bool report(const fs::path& folder, int row_count, const Cost& one, const Cost& two, const Killer& killer) {
  bool same = true;
  for (const char* name : {"collected.csv", "collected.json"})
    for (const char* sweep : {"two", "disturbed"}) same = same && contentOf(folder / "one" / name) == contentOf(folder / sweep / name);
  fmt::print("rows {}\nruns begun in the disturbed sweep {}\nruns killed {}\nworkers killed in mid-row {}\ntables identical {}\n",
             row_count, killer.seenRuns(), killer.killedRuns(), killer.killedWorkers(), same ? "yes" : "NO");
  fmt::print("one worker {:.2f} s wall, {:.2f} s processor\ntwo workers {:.2f} s wall, {:.2f} s processor\n", one.wall_s, one.cpu_s,
             two.wall_s, two.cpu_s);
  fmt::print("efficiency of two workers, wall time {:.1f} %\nefficiency of two workers, processor time {:.1f} %\n",
             100 * one.wall_s / (2 * two.wall_s), 100 * one.cpu_s / two.cpu_s);
  return same && killer.killedWorkers() == 1 && killer.killedRuns() > row_count / 20;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count < 2) {
    fmt::print(stderr, "usage: sweep_study PROGRAM [rows = 500] [seed = 1]\n");
    return 2;
  }
  const std::string program = fs::absolute(arguments[1]).string();
  const int row_count = argument_count > 2 ? std::stoi(arguments[2]) : 500;
  const std::uint64_t seed = argument_count > 3 ? std::stoull(arguments[3]) : 1;
  const fs::path folder = fs::temp_directory_path() / fmt::format("musclesim_sweep_study_{}", getpid());
  const Sweep plan = parsePlan(planText(row_count), "plan.toml");
  for (const char* sweep : {"one", "two", "disturbed"}) writeSweep(plan, (folder / sweep).string());
  const Cost one = workOn(program, (folder / "one").string(), 1), two = workOn(program, (folder / "two").string(), 2);
  Killer killer(row_count, seed);
  workOn(program, (folder / "disturbed").string(), 2, [&](const auto& workers) { killer.disturb(workers); });
  bool complete = true;
  for (const char* sweep : {"one", "two", "disturbed"}) complete = collect((folder / sweep).string()).complete() && complete;
  const bool good = report(folder, row_count, one, two, killer) && complete;
  fs::remove_all(folder);
  return good ? 0 : 1;
}
