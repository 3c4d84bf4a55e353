/// In `si` physics: how the motion of the arm converges as the internal step shrinks, and the cost of each step.
/// Usage: internal_step_study [--muscles N] [--recording FILE.csv] [--document docs/developer/stepper.md] [--seed N] [--steps MS,MS,...]
/// [name=value
/// ...] The commands are those of the recording, with times divided by sqrt(1000); without a recording they are random, with new ones every
/// 0.19 s.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>

#include "../../simulation/chain/chain_stepper.h"
#include "musclesim/simulation/simulation.h"
#include "study.h"

using namespace musclesim;

namespace {

struct Settings {
  int muscle_count = 10;
  double duration_s = 0.4;
  std::uint64_t seed = 1;
  std::optional<std::string> recording, document;
  std::vector<double> steps_ms = {2, 1.5, 1, 0.5, 0.2, 0.1, 0.05};
  std::vector<std::string> parameters;
};

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    auto value = [&] { return std::string(i + 1 < argc ? argv[++i] : ""); };
    if (word == "--muscles")
      settings.muscle_count = std::stoi(value());
    else if (word == "--recording")
      settings.recording = value();
    else if (word == "--document")
      settings.document = value();
    else if (word == "--seed")
      settings.seed = std::stoull(value());
    else if (word == "--duration")
      settings.duration_s = std::stod(value());
    else if (word == "--steps") {
      settings.steps_ms.clear();
      std::stringstream list(value());
      for (std::string one; std::getline(list, one, ',');) settings.steps_ms.push_back(std::stod(one));
    } else
      settings.parameters.push_back(word);
  }
  return settings;
}

struct Path {
  double step_ms = 0;
  std::vector<Vector> hand_mm;  ///< every 10 ms
  double gap_mm = 0, ratio = 0, rounds = 0;
  int contacts = 0;
  std::string joint, end = "done";
};

/// One run with internal steps of 10 ms / substeps.
Path run(const Settings& settings, const Schedule& schedule, double step_ms) {
  SimulationOptions options;
  options.substeps = static_cast<int>(std::lround(10 / step_ms));
  options.parameters.set("arm.muscle_count", static_cast<double>(settings.muscle_count), "study");
  for (const auto& assignment : settings.parameters) options.parameters.setFromText(assignment, "study");
  Simulation simulation(std::move(options));
  Robot& robot = simulation.build("arm");
  Path path;
  path.step_ms = 1e3 * simulation.internalStepS();
  const double begin = cpuSeconds();
  try {
    for (long i = 0; i < std::lround(settings.duration_s / simulation.stepS()); ++i) {
      robot.step(schedule.at(simulation.time_s(), settings.muscle_count));
      simulation.step();
      path.hand_mm.push_back(*robot.getState().hand_mm);
      path.contacts = std::max(path.contacts, simulation.contactCount());
    }
  } catch (const Diverged& error) {
    path.end = "diverged";
  }
  path.ratio = (cpuSeconds() - begin) / simulation.time_s();
  path.gap_mm = simulation.worstGap().gap_mm;
  path.joint = simulation.worstGap().joint;
  if (const auto* chain = dynamic_cast<const ChainStepper*>(&simulation.stepper()))
    path.rounds = static_cast<double>(chain->statistics().rounds) / static_cast<double>(chain->statistics().steps);
  return path;
}

double distanceAt(const Path& path, const Path& reference, double time_s) {
  const auto i = static_cast<std::size_t>(std::lround(time_s / 0.01)) - 1;
  if (i >= path.hand_mm.size() || i >= reference.hand_mm.size()) return std::nan("");
  return (path.hand_mm[i] - reference.hand_mm[i]).norm();
}

double worstUntil(const Path& path, const Path& reference, double time_s) {
  double worst = 0;
  for (double t = 0.01; t <= time_s + 1e-9; t += 0.01) worst = std::max(worst, distanceAt(path, reference, t));
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  const Settings settings = parse(argc, argv);
  const Schedule schedule = settings.recording ? scheduleOf(*settings.recording, std::sqrt(1000.0))
                                               : randomSchedule(6 / std::sqrt(1000.0), settings.duration_s, settings.seed);
  std::vector<Path> paths;
  for (const double step_ms : settings.steps_ms) paths.push_back(run(settings, schedule, step_ms));
  const Path& reference = paths.back();
  std::string table =
      fmt::format("Arm with {} muscles; distances of the hand from the path with the shortest step.\n\n", settings.muscle_count);
  table +=
      "| internal step ms | at 0.1 s mm | largest until 0.1 s | at 0.3 s | largest until 0.3 s | joint gap mm | CPU s per s | rounds | "
      "contacts | end |\n";
  for (const Path& p : paths) fmt::print("{} ", p.joint);
  table += "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Path& p : paths)
    table += fmt::format("| {:.3g} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.3f} | {:.3f} | {:.2f} | {} | {} |\n", p.step_ms,
                         distanceAt(p, reference, 0.1), worstUntil(p, reference, 0.1), distanceAt(p, reference, 0.3),
                         worstUntil(p, reference, 0.3), p.gap_mm, p.ratio, p.rounds, p.contacts, p.end);
  fmt::print("{}", table);
  if (settings.document) writeSection(*settings.document, "convergence", "internal_step_study", table);
}
