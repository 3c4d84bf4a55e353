/// Relative difference of velocities between the chain stepper and dWorldStep, step by step from the same state along dWorldStep's path.
/// Usage: step_exactness [--document docs/developer/stepper.md] [--resume] [--quick]
/// --quick: a tenth of the steps.   --resume: does not repeat rows that are already in the document.
/// Moving: random pressures, new ones every 0.25 s of true time. Resting: the first pressures held, 20 s of true time beforehand (5 s for
/// more than ten muscles).
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>

#include "simulation/step_comparison.h"
#include "study.h"

using namespace musclesim;

namespace {

/// The part of a row that identifies it.
std::string beginningOf(const ComparisonCase& c) {
  return fmt::format("| {}{} | `{}` | {} | {} | ", c.robot, c.muscle_count ? fmt::format(", n = {}", c.muscle_count) : "",
                     nameOf(c.physics), c.hold_s > 0 ? "moving" : "resting", c.steps);
}

std::string row(const ComparisonCase& c, double seconds) {
  const Comparison r = compareSteps(c);
  return beginningOf(c) + fmt::format("{:.1e} | {:.1f} | {} | {:.2g} | {:.2f} | {} | {:.0f} |\n", r.worst, r.mean_log10, r.contacts,
                                      r.fastest_mm_per_s, static_cast<double>(r.chain.rounds) / static_cast<double>(r.chain.steps),
                                      r.chain.unsolved_steps, cpuSeconds() - seconds);
}

std::vector<std::string> linesOf(const std::string& document) {
  std::vector<std::string> lines;
  std::ifstream in(document);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The line that begins with this text, with its end of line; "" if there is none.
std::string rowOf(const std::vector<std::string>& lines, const std::string& beginning) {
  for (const std::string& line : lines)
    if (line.starts_with(beginning)) return line + "\n";
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  std::optional<std::string> document;
  int divisor = 1;
  bool resume = false;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--quick") divisor = 10;
    if (std::string(argv[i]) == "--resume") resume = true;
    if (std::string(argv[i]) == "--document" && i + 1 < argc) document = argv[++i];
  }
  const std::vector<std::string> known = resume && document ? linesOf(*document) : std::vector<std::string>();
  struct Robots {
    const char* name;
    int muscle_count, steps;
  };
  std::string table =
      "| robot | physics | state | steps | worst | mean log10 | contacts <= | fastest mm/s | rounds | unsolved | CPU s |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::fputs(table.c_str(), stdout);
  for (const auto& [name, count, steps] : {Robots{"rig", 0, 1000}, Robots{"elbow", 0, 1000}, Robots{"arm", 1, 1000}, Robots{"arm", 5, 1000},
                                           Robots{"arm", 10, 1000}, Robots{"arm", 20, 100}, Robots{"arm", 30, 100}})
    for (const PhysicsKind physics : {PhysicsKind::original, PhysicsKind::si})
      for (const bool moving : {true, false}) {
        const double slowness = physics == PhysicsKind::original ? std::sqrt(1000.0) : 1;
        ComparisonCase c{.robot = name, .physics = physics, .muscle_count = count, .steps = std::max(1, steps / divisor)};
        c.hold_s = moving ? 0.25 * slowness : 0;
        // Large arms get only a few steps, so these start when the motion is well under way.
        c.rest_s = moving ? (count > 10 ? 0.1 * slowness : 0) : (count > 10 ? 5 : 20) * slowness / divisor;
        std::string line = rowOf(known, beginningOf(c));
        if (line.empty()) line = row(c, cpuSeconds());
        std::fputs(line.c_str(), stdout);
        std::fflush(stdout);
        table += line;
        if (document) writeSection(*document, "exactness", "step_exactness", table);
      }
}
