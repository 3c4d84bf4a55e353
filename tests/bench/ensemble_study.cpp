/// Throughput of several simulations in one process: one thread against two, the same simulations.
/// Usage: ensemble_study [--document docs/stepper.md]
/// CPU time tells what threads cost each other even where other programs use the machine: throughput = threads * serial CPU / parallel CPU.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "musclesim/simulation/ensemble.h"
#include "musclesim/simulation/simulation.h"
#include "study.h"

using namespace musclesim;

namespace {

constexpr int simulation_count = 8;

struct Measured {
  double wall_s = 0, cpu_s = 0;
  std::vector<Vector> hands = std::vector<Vector>(simulation_count);
};

Vector simulate(int seed) {
  Simulation simulation;
  Robot& robot = simulation.build("arm");
  const Schedule schedule = randomSchedule(0.25, 1.0, static_cast<std::uint64_t>(seed), 10);
  while (simulation.time_s() < 1 - 1e-9) {
    robot.step(schedule.at(simulation.time_s(), 10));
    simulation.step();
  }
  return *robot.getState().hand_mm;
}

Measured measure(int thread_count) {
  Measured measured;
  std::vector<double> cpu_s(simulation_count);
  const auto begin = std::chrono::steady_clock::now();
  runEnsemble(simulation_count, thread_count, [&](int i) {
    const double before = cpuSeconds();
    measured.hands[static_cast<std::size_t>(i)] = simulate(i);
    cpu_s[static_cast<std::size_t>(i)] = cpuSeconds() - before;
  });
  measured.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const double one : cpu_s) measured.cpu_s += one;
  return measured;
}

}  // namespace

int main(int argc, char** argv) {
  measure(1);  // warm up
  const Measured serial = measure(1), parallel = measure(2);
  const bool same = std::equal(serial.hands.begin(), serial.hands.end(), parallel.hands.begin());
  double load[1] = {0};
  getloadavg(load, 1);
  const std::string text = fmt::format(
      "{} arms in `si`, 1 s each: {:.2f} s of CPU time on one thread, {:.2f} s on two: throughput x {:.2f} by CPU time; wall time {:.2f} s "
      "and\n"
      "{:.2f} s, x {:.2f}, with a load of {:.1f} on {} processors. Bits of the hands' positions: {}.\n",
      simulation_count, serial.cpu_s, parallel.cpu_s, 2 * serial.cpu_s / parallel.cpu_s, serial.wall_s, parallel.wall_s,
      serial.wall_s / parallel.wall_s, load[0], std::thread::hardware_concurrency(), same ? "the same" : "DIFFERENT");
  fmt::print("{}", text);
  if (argc == 3 && std::strcmp(argv[1], "--document") == 0) writeSection(argv[2], "ensemble", "ensemble_study", text);
  return same ? 0 : 1;
}
