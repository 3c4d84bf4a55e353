/// CPU time of the chain stepper and of dWorldStep on the arm in `original` physics, in one process.
/// Usage: step_speed RECORDING.csv ... [--time-limit S] [--document docs/developer/stepper.md]
/// Commands are those of the recordings, in their order; muscles beyond the tenth repeat them. dWorldStep runs until the time limit
/// (default: 60 s of CPU time with 30 muscles, none with ten), the chain stepper over the same steps.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "simulation/step_comparison.h"
#include "study.h"

using namespace musclesim;

namespace {

constexpr double no_limit_s = 1e9, usual_limit_s = 60;

struct Timing {
  long steps = 0;
  double cpu_s = 0;
  double msPerStep() const { return 1e3 * cpu_s / static_cast<double>(steps); }
};

/// Runs up to a number of steps within a CPU time.
Timing run(StepperKind stepper, const Schedule& schedule, int muscle_count, long steps, double time_limit_s) {
  ComparisonCase c;
  c.muscle_count = muscle_count;
  const auto simulation = makeSimulation(c, stepper);
  Timing timing;
  const double begin = cpuSeconds();
  for (; timing.steps < steps && timing.cpu_s < time_limit_s; ++timing.steps, timing.cpu_s = cpuSeconds() - begin) {
    simulation->robot().step(schedule.at(simulation->time_s(), muscle_count));
    simulation->step();
  }
  return timing;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> recordings;
  std::optional<std::string> document;
  std::optional<double> time_limit_s;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--time-limit" && i + 1 < argc)
      time_limit_s = std::atof(argv[++i]);
    else if (word == "--document" && i + 1 < argc)
      document = argv[++i];
    else
      recordings.push_back(word);
  }
  std::string table =
      "| recording | muscles | simulated s | dWorldStep ms per step | chain stepper ms per step | ratio | r of the chain stepper |\n"
      "|---|---|---|---|---|---|---|\n";
  std::fputs(table.c_str(), stdout);
  for (const std::string& file : recordings)
    for (const auto& [muscles, seconds] : {std::pair{10, 5.0}, std::pair{10, 30.0}, std::pair{30, 5.0}}) {
      const Schedule schedule = scheduleOf(file, 1);
      const Timing ode = run(StepperKind::ode, schedule, muscles, std::lround(seconds / 0.01),
                             time_limit_s.value_or(muscles > 10 ? usual_limit_s : no_limit_s));
      const Timing chain = run(StepperKind::chain, schedule, muscles, ode.steps, no_limit_s);
      const std::string line = fmt::format("| {} | {} | {:.2f} | {:.2f} | {:.4f} | {:.0f} | {:.4f} |\n",
                                           std::filesystem::path(file).stem().string(), muscles, static_cast<double>(ode.steps) * 0.01,
                                           ode.msPerStep(), chain.msPerStep(), ode.msPerStep() / chain.msPerStep(), chain.msPerStep() / 10);
      std::fputs(line.c_str(), stdout);
      std::fflush(stdout);
      table += line;
    }
  if (document) writeSection(*document, "speed", "step_speed", table);
}
