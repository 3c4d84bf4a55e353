/// Throughput of several simulations in one process: one thread against two, the same simulations.
/// Usage: ensemble_study [--document docs/developer/stepper.md]
/// Throughput = threads * serial time / parallel time. The times are wall times of all simulations minus the time their threads waited for
/// a processor (Linux: schedstat), so other programs on the machine do not count, but waiting for each other does.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

#include "musclesim/simulation/ensemble.h"
#include "musclesim/simulation/simulation.h"
#include "study.h"

using namespace musclesim;

namespace {

constexpr int simulation_count = 8;

struct Measured {
  double wall_s = 0, own_s = 0;
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

double clockSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// How long the calling thread has waited for a processor while it was ready to run.
double queuedSeconds() {
  std::ifstream file("/proc/thread-self/schedstat");
  double running_ns = 0, queued_ns = 0;
  if (!(file >> running_ns >> queued_ns)) throw std::runtime_error("there is no /proc/thread-self/schedstat");
  return 1e-9 * queued_ns;
}

Measured measure(int thread_count) {
  Measured measured;
  std::vector<double> own_s(simulation_count);
  const double begin = clockSeconds();
  runEnsemble(simulation_count, thread_count, [&](int i) {
    const double before = clockSeconds() - queuedSeconds();
    measured.hands[static_cast<std::size_t>(i)] = simulate(i);
    own_s[static_cast<std::size_t>(i)] = clockSeconds() - queuedSeconds() - before;
  });
  measured.wall_s = clockSeconds() - begin;
  for (const double one : own_s) measured.own_s += one;
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
      "{} arms in `si`, 1 s each: {:.2f} s on one thread, {:.2f} s on two, added up over the simulations, without waiting for a "
      "processor:\n"
      "throughput x {:.2f}. Wall time of all {:.2f} s and {:.2f} s, x {:.2f}, with a load of {:.1f} on {} processors. Bits of the hands' "
      "positions: {}.\n",
      simulation_count, serial.own_s, parallel.own_s, 2 * serial.own_s / parallel.own_s, serial.wall_s, parallel.wall_s,
      serial.wall_s / parallel.wall_s, load[0], std::thread::hardware_concurrency(), same ? "the same" : "DIFFERENT");
  fmt::print("{}", text);
  if (argc == 3 && std::strcmp(argv[1], "--document") == 0) writeSection(argv[2], "ensemble", "ensemble_study", text);
  return same ? 0 : 1;
}
