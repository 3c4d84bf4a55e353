// CPU time of the chain stepper and of dWorldStep on the arm, in one process.
// Usage: step_speed recording.csv muscles duration_s ode_steps [physics]
// Commands are those of the recording, in its order; further muscles repeat them.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>

#include "simulation/step_comparison.h"

using namespace musclesim;

namespace {

struct Schedule {
  std::vector<double> time_s;
  std::vector<Action> command;
};

Schedule readSchedule(const char* file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  Schedule schedule;
  while (std::getline(in, line)) {
    std::stringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    schedule.time_s.push_back(std::atof(cell.c_str()));
    Action command;
    for (int i = 0; i < 10 && std::getline(cells, cell, ','); ++i) command.push_back(std::atof(cell.c_str()));
    schedule.command.push_back(command);
  }
  return schedule;
}

double cpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Milliseconds of CPU time per control step.
double run(Simulation& simulation, const Schedule& schedule, long steps, double time_scale) {
  const auto muscles = static_cast<std::size_t>(simulation.robot().actuatorCount());
  Action command(muscles, 0.0);
  std::size_t row = 0;
  const double begin = cpuSeconds();
  for (long i = 0; i < steps; ++i) {
    const double time_s = static_cast<double>(i) * simulation.stepS() * time_scale;
    while (row + 1 < schedule.time_s.size() && schedule.time_s[row + 1] <= time_s + 1e-9) ++row;
    for (std::size_t m = 0; m < muscles; ++m) command[m] = schedule.command[row][m % 10];
    simulation.robot().step(command);
    simulation.step();
  }
  return (cpuSeconds() - begin) / static_cast<double>(steps) * 1e3;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  const Schedule schedule = readSchedule(argv[1]);
  ComparisonCase c;
  c.muscle_count = std::atoi(argv[2]);
  const double duration_s = std::atof(argv[3]);
  const long ode_steps = std::atol(argv[4]);
  if (argc > 5) c.physics = physicsFromName(argv[5]);
  const double time_scale = c.physics == PhysicsKind::original ? 1 : std::sqrt(1000.0);
  double ode_ms = 0;
  if (ode_steps > 0) ode_ms = run(*makeSimulation(c, StepperKind::ode), schedule, ode_steps, time_scale);
  const auto chain = makeSimulation(c, StepperKind::chain);
  const double chain_ms = run(*chain, schedule, std::lround(duration_s / chain->stepS()), time_scale);
  const ChainStatistics& s = dynamic_cast<const ChainStepper&>(chain->stepper()).statistics();
  std::printf(
      "n=%d %s: ode %.3f ms (%ld steps), chain %.4f ms (%ld steps), ratio %.1f, r %.4f; rounds %.2f (<= %d, monotone %ld), unsolved %ld\n",
      c.muscle_count, nameOf(c.physics).c_str(), ode_ms, ode_steps, chain_ms, s.steps, ode_ms / chain_ms, chain_ms * 1e-3 / chain->stepS(),
      static_cast<double>(s.rounds) / static_cast<double>(s.steps), s.largest_rounds, s.monotone_rounds, s.unsolved_steps);
}
