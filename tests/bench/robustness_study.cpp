/// 20,000 internal steps of the arm under random pressures, new ones every 0.25 s, for many seeds: does any run diverge, leave a step
/// unsolved, or allocate memory?
/// Usage: robustness_study [--muscles 10,30] [--seeds 20] [--steps 20000] [--threads 1] [--physics si] [--document
/// docs/developer/stepper.md] [name=value ...] With several threads simulations run side by side, one per thread; allocations are counted
/// per thread.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <optional>

#include "../../simulation/chain/chain_stepper.h"
#include "musclesim/simulation/ensemble.h"
#include "musclesim/simulation/simulation.h"
#include "study.h"
#include "support/count_allocations.h"

using namespace musclesim;

namespace {

struct Settings {
  std::vector<int> muscle_counts = {10, 30};
  int seed_count = 20, thread_count = 1;
  long steps = 20000;
  PhysicsKind physics = PhysicsKind::si;
  std::optional<std::string> document;
  std::vector<std::string> parameters;
};

struct Outcome {
  int diverged = 0, contacts = 0, largest_rounds = 0;
  long steps = 0, unsolved = 0, allocations = 0, rounds = 0, monotone_rounds = 0;
  double gap_mm = 0, cpu_s = 0, simulated_s = 0;
  std::string first_divergence;

  void add(const Outcome& other) {
    diverged += other.diverged, steps += other.steps, unsolved += other.unsolved, allocations += other.allocations;
    rounds += other.rounds, monotone_rounds += other.monotone_rounds, cpu_s += other.cpu_s, simulated_s += other.simulated_s;
    contacts = std::max(contacts, other.contacts), gap_mm = std::max(gap_mm, other.gap_mm);
    largest_rounds = std::max(largest_rounds, other.largest_rounds);
    if (first_divergence.empty()) first_divergence = other.first_divergence;
  }
};

Outcome run(const Settings& settings, int muscle_count, std::uint64_t seed) {
  SimulationOptions options;
  options.seed = seed;
  options.physics = settings.physics;
  options.parameters.set("arm.muscle_count", static_cast<double>(muscle_count), "study");
  for (const auto& assignment : settings.parameters) options.parameters.setFromText(assignment, "study");
  Simulation simulation(std::move(options));
  Robot& robot = simulation.build("arm");
  RandomStream random(seed, "robustness.pressures");
  const double slowness = settings.physics == PhysicsKind::original ? std::sqrt(1000.0) : 1;
  const long hold = std::lround(0.25 * slowness / simulation.stepS()), warm_up = 20;
  Action command(static_cast<std::size_t>(muscle_count));
  const auto& statistics = dynamic_cast<const ChainStepper&>(simulation.stepper()).statistics();
  Outcome outcome;
  const double begin = cpuSeconds();
  try {
    for (long i = 0; statistics.steps < settings.steps; ++i) {
      if (i % hold == 0)
        for (double& pressure : command) pressure = random.uniform();
      robot.step(command);
      const long before = allocation_count;
      simulation.step();
      if (i >= warm_up) outcome.allocations += allocation_count - before;
      outcome.contacts = std::max(outcome.contacts, simulation.contactCount());
    }
  } catch (const Diverged& error) {
    outcome.diverged = 1;
    outcome.first_divergence = fmt::format("seed {}: {}", seed, error.what());
  }
  outcome.cpu_s = cpuSeconds() - begin;
  outcome.simulated_s = simulation.time_s();
  outcome.steps = statistics.steps;
  outcome.unsolved = statistics.unsolved_steps;
  outcome.rounds = statistics.rounds;
  outcome.monotone_rounds = statistics.monotone_rounds;
  outcome.largest_rounds = statistics.largest_rounds;
  outcome.gap_mm = simulation.worstGap().gap_mm;
  return outcome;
}

/// Runs all seeds, distributed over the threads.
Outcome runAll(const Settings& settings, int muscle_count) {
  std::vector<Outcome> outcomes(static_cast<std::size_t>(settings.seed_count));
  runEnsemble(settings.seed_count, settings.thread_count, [&](int i) {
    Outcome& outcome = outcomes[static_cast<std::size_t>(i)];
    outcome = run(settings, muscle_count, static_cast<std::uint64_t>(i) + 1);
    std::fprintf(stderr, "%d muscles, seed %d: r = %.3f, gap %.2f mm%s\n", muscle_count, i + 1, outcome.cpu_s / outcome.simulated_s,
                 outcome.gap_mm, outcome.diverged ? ", diverged" : "");
  });
  Outcome total;
  for (const Outcome& outcome : outcomes) total.add(outcome);
  return total;
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] { return std::string(i + 1 < argc ? argv[++i] : ""); };
    if (word == "--seeds")
      settings.seed_count = std::stoi(value());
    else if (word == "--steps")
      settings.steps = std::stol(value());
    else if (word == "--physics")
      settings.physics = physicsFromName(value());
    else if (word == "--threads")
      settings.thread_count = std::stoi(value());
    else if (word == "--document")
      settings.document = value();
    else if (word == "--muscles") {
      settings.muscle_counts.clear();
      std::stringstream list(value());
      for (std::string one; std::getline(list, one, ',');) settings.muscle_counts.push_back(std::stoi(one));
    } else
      settings.parameters.push_back(word);
  }
  return settings;
}

}  // namespace

int main(int argc, char** argv) {
  const Settings settings = parse(argc, argv);
  std::string table = fmt::format("{} seeds with at least {} internal steps each{}.\n\n", settings.seed_count, settings.steps,
                                  settings.parameters.empty() ? "" : fmt::format(" ({})", fmt::join(settings.parameters, ", ")));
  table +=
      "| muscles | steps | diverged | unsolved steps | allocations | rounds mean | largest | monotone | joint gap mm | contacts | CPU s "
      "per s |\n";
  table += "|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const int muscle_count : settings.muscle_counts) {
    const Outcome o = runAll(settings, muscle_count);
    table += fmt::format("| {} | {} | {} | {} | {} | {:.2f} | {} | {} | {:.2f} | {} | {:.3f} |\n", muscle_count, o.steps, o.diverged,
                         o.unsolved, o.allocations, static_cast<double>(o.rounds) / static_cast<double>(o.steps), o.largest_rounds,
                         o.monotone_rounds, o.gap_mm, o.contacts, o.cpu_s / o.simulated_s);
    if (!o.first_divergence.empty()) fmt::print("{}\n", o.first_divergence);
  }
  fmt::print("{}", table);
  if (settings.document) writeSection(*settings.document, "robustness", "robustness_study", table);
}
