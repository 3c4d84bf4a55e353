// Relative difference of velocities between the chain stepper and dWorldStep, step by step from the same state.
// Usage: step_exactness [robot physics muscles steps hold_s initial_state seed]
#include <cstdio>
#include <cstdlib>

#include "simulation/step_comparison.h"

using namespace musclesim;

namespace {

void report(const ComparisonCase& c) {
  const Comparison r = compareSteps(c);
  std::printf(
      "%-6s %-9s n=%-3d %6d steps from %-8s hold %-5g worst %.2e mean log10 %.2f contacts <= %d rounds %.2f (<= %d, monotone %ld) unsolved "
      "%ld\n",
      c.robot.c_str(), nameOf(c.physics).c_str(), c.muscle_count, c.steps, c.initial_state.c_str(), c.hold_s, r.worst, r.mean_log10,
      r.contacts, static_cast<double>(r.chain.rounds) / static_cast<double>(r.chain.steps), r.chain.largest_rounds, r.chain.monotone_rounds,
      r.chain.unsolved_steps);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  ComparisonCase c;
  if (argc > 1) c.robot = argv[1];
  if (argc > 2) c.physics = physicsFromName(argv[2]);
  if (argc > 3) c.muscle_count = std::atoi(argv[3]);
  if (argc > 4) c.steps = std::atoi(argv[4]);
  if (argc > 5) c.hold_s = std::atof(argv[5]);
  if (argc > 6) c.initial_state = argv[6];
  if (argc > 7) c.seed = static_cast<std::uint64_t>(std::atoll(argv[7]));
  report(c);
}
