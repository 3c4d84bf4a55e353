/// Relative difference of velocities between the chain stepper and dWorldStep, step by step from the same state along dWorldStep's path.
/// Usage: step_exactness [--document docs/stepper.md] [--quick]      --quick: a tenth of the steps
/// Moving: random pressures, new ones every 0.25 s of true time. Resting: the first pressures held, 20 s of true time beforehand.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <optional>

#include "simulation/step_comparison.h"
#include "study.h"

using namespace musclesim;

namespace {

std::string row(const ComparisonCase& c, double seconds) {
  const Comparison r = compareSteps(c);
  return fmt::format("| {}{} | `{}` | {} | {} | {:.1e} | {:.1f} | {} | {:.2g} | {:.2f} | {} | {:.0f} |\n", c.robot,
                     c.muscle_count ? fmt::format(", n = {}", c.muscle_count) : "", nameOf(c.physics), c.hold_s > 0 ? "moving" : "resting",
                     c.steps, r.worst, r.mean_log10, r.contacts, r.fastest_mm_per_s,
                     static_cast<double>(r.chain.rounds) / static_cast<double>(r.chain.steps), r.chain.unsolved_steps,
                     cpuSeconds() - seconds);
}

}  // namespace

int main(int argc, char** argv) {
  std::optional<std::string> document;
  int divisor = 1;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--quick") divisor = 10;
    if (std::string(argv[i]) == "--document" && i + 1 < argc) document = argv[++i];
  }
  struct Robots {
    const char* name;
    int muscle_count, steps;
  };
  std::string table =
      "| robot | physics | state | steps | worst | mean log10 | contacts <= | fastest mm/s | rounds | unsolved | CPU s |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::fputs(table.c_str(), stdout);
  for (const auto& [name, count, steps] : {Robots{"rig", 0, 1000}, Robots{"elbow", 0, 1000}, Robots{"arm", 1, 1000}, Robots{"arm", 5, 1000},
                                           Robots{"arm", 10, 1000}, Robots{"arm", 20, 100}, Robots{"arm", 30, 20}})
    for (const PhysicsKind physics : {PhysicsKind::original, PhysicsKind::si})
      for (const bool moving : {true, false}) {
        const double slowness = physics == PhysicsKind::original ? std::sqrt(1000.0) : 1;
        ComparisonCase c{.robot = name, .physics = physics, .muscle_count = count, .steps = std::max(1, steps / divisor)};
        c.hold_s = moving ? 0.25 * slowness : 0;
        // Large arms: a few steps only, so the motion is well under way before them.
        c.rest_s = moving ? (count > 10 ? 0.1 * slowness : 0) : 20 * slowness / divisor;
        const std::string line = row(c, cpuSeconds());
        std::fputs(line.c_str(), stdout);
        std::fflush(stdout);
        table += line;
        if (document) writeSection(*document, "exactness", "step_exactness", table);
      }
}
