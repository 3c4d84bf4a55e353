/// Effect of viscous instead of dry friction in the joints of the muscles: the same commands with each, in `si`.
/// Usage: joint_friction_study [--document docs/developer/stepper.md]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "../../simulation/chain/chain_stepper.h"
#include "musclesim/simulation/simulation.h"
#include "study.h"

using namespace musclesim;

namespace {

constexpr double hold_s = 4, near_mm = 20;
constexpr int decision_count = 5;

std::unique_ptr<Simulation> simulationOf(const std::string& robot, const std::string& friction) {
  SimulationOptions options;
  options.parameters.setFromText("muscle.joint_friction=" + friction, "study");
  auto simulation = std::make_unique<Simulation>(std::move(options));
  simulation->build(robot);
  return simulation;
}

/// The arm under random pressures, each held for 4 s.
struct ArmRun {
  std::vector<Vector> hand_mm;  ///< every 10 ms
  double settling_s = 0, slow_mm = 0, ratio = 0, rounds = 0;
};

/// After every change of pressure: the time after which the hand stays within 20 mm of its final position, and the distance it travels in
/// the last second.
void addSettling(ArmRun& run, double step_s) {
  const auto per_hold = static_cast<std::size_t>(std::lround(hold_s / step_s));
  for (std::size_t first = 0; first + per_hold <= run.hand_mm.size(); first += per_hold) {
    const Vector& end = run.hand_mm[first + per_hold - 1];
    std::size_t last_far = first;
    for (std::size_t i = first; i < first + per_hold; ++i)
      if ((run.hand_mm[i] - end).norm() > near_mm) last_far = i;
    run.settling_s += static_cast<double>(last_far - first + 1) * step_s / decision_count;
    for (std::size_t i = first + per_hold * 3 / 4 + 1; i < first + per_hold; ++i)
      run.slow_mm += (run.hand_mm[i] - run.hand_mm[i - 1]).norm() / decision_count;
  }
}

ArmRun runArm(const std::string& friction, std::uint64_t seed) {
  const auto simulation = simulationOf("arm", friction);
  const Schedule schedule = randomSchedule(hold_s, hold_s * decision_count, seed, 10);
  ArmRun run;
  const double begin = cpuSeconds();
  for (long i = 0; i < std::lround(hold_s * decision_count / simulation->stepS()); ++i) {
    simulation->robot().step(schedule.at(simulation->time_s(), 10));
    simulation->step();
    run.hand_mm.push_back(*simulation->robot().getState().hand_mm);
  }
  run.ratio = (cpuSeconds() - begin) / simulation->time_s();
  const auto& statistics = dynamic_cast<const ChainStepper&>(simulation->stepper()).statistics();
  run.rounds = static_cast<double>(statistics.rounds) / static_cast<double>(statistics.steps);
  addSettling(run, simulation->stepS());
  return run;
}

/// The rig at pressure 0.5, approached from a lower and from a higher pressure.
struct RigRun {
  double difference_mm = 0;  ///< difference of the two rest lengths
  double rest_s = 0;         ///< time after which the length stays within 1 mm; the longer of the two
};

RigRun runRig(const std::string& friction) {
  constexpr double rig_hold_s = 20;
  RigRun run;
  for (const double pressure_before : {0.1, 0.9}) {
    const auto simulation = simulationOf("rig", friction);
    std::vector<double> length_mm;
    for (const double pressure : {pressure_before, 0.5}) {
      length_mm.clear();
      for (long k = 0; k < std::lround(rig_hold_s / simulation->stepS()); ++k) {
        simulation->robot().step(Action{pressure});
        simulation->step();
        length_mm.push_back(simulation->world().actuators().front()->lengthMm());
      }
    }
    const double end_mm = length_mm.back();
    while (std::abs(length_mm.back() - end_mm) <= 1) length_mm.pop_back();
    run.rest_s = std::max(run.rest_s, static_cast<double>(length_mm.size()) * simulation->stepS());
    run.difference_mm += pressure_before < 0.5 ? end_mm : -end_mm;
  }
  return run;
}

}  // namespace

int main(int argc, char** argv) {
  std::optional<std::string> document;
  for (int i = 1; i + 1 < argc; ++i)
    if (std::string(argv[i]) == "--document") document = argv[i + 1];
  std::string table = fmt::format(
      "Arm with 10 muscles, random pressures, each held for {:g} s, {} times; rig: pressure 0.5 after 0.1 and "
      "after 0.9.\n\n",
      hold_s, decision_count);
  table +=
      "| joint friction | hand settles within 20 mm after s | way of the hand in the last second of a hold mm | rig stays within 1 mm "
      "after s | rig: difference of lengths mm | rounds | CPU s per s |\n|---|---|---|---|---|---|---|\n";
  ArmRun runs[2];
  for (int i = 0; i < 2; ++i) {
    const std::string friction = i == 0 ? "coulomb" : "viscous";
    const ArmRun& run = runs[i] = runArm(friction, 1);
    const RigRun rig = runRig(friction);
    table += fmt::format("| `{}` | {:.2f} | {:.1f} | {:.1f} | {:.2f} | {:.2f} | {:.3f} |\n", friction, run.settling_s, run.slow_mm,
                         rig.rest_s, rig.difference_mm, run.rounds, run.ratio);
  }
  const auto distance = [&](double time_s) {
    const auto i = static_cast<std::size_t>(std::lround(time_s / 0.01)) - 1;
    return (runs[0].hand_mm[i] - runs[1].hand_mm[i]).norm();
  };
  table += fmt::format("\nThe two hands are {:.0f} mm apart after 0.1 s, {:.0f} mm after 0.3 s and {:.0f} mm after {:g} s.\n",
                       distance(0.1), distance(0.3), distance(hold_s), hold_s);
  fmt::print("{}", table);
  if (document) writeSection(*document, "friction", "joint_friction_study", table);
}
