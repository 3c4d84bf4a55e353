// Cost of the effects of one stage: CPU time of a control step of the arm with all of them active on all components, over the time without
// effects. Usage: effect_cost [--document docs/reference/effects.md]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "effect_recordings.h"
#include "study.h"

using namespace musclesim;

namespace {

/// All effects of a stage, weak enough that the motion hardly changes.
std::vector<ActiveEffect> allOf(Stage stage, const Robot& robot) {
  std::vector<ActiveEffect> effects;
  for (const EffectInfo& info : effectCatalogue()) {
    if (info.stage != stage) continue;
    std::vector<double> values;
    for (const EffectParameter& p : info.parameters) {
      const double toward = std::isinf(p.neutral) ? p.usual_high : p.neutral + 1e-3 * (p.usual_high - p.neutral);
      values.push_back(p.shape ? p.neutral : !p.choices.empty() ? 1 : toward);
    }
    for (const std::string& component : componentsFor(info, robot)) {
      effects.push_back(activeEffect(info, component, values));
      break;  // "all", or the first component
    }
  }
  return effects;
}

/// A running arm.
struct Arm {
  Simulation simulation;
  double best_s = 1e9, stages_s = 1e9;
  explicit Arm(std::vector<ActiveEffect> effects) : simulation(optionsWith(std::move(effects))) {
    simulation.build("arm");
    simulation.start("built", Action(10, 0.3));
  }
  static SimulationOptions optionsWith(std::vector<ActiveEffect> effects) {
    SimulationOptions options;
    options.effects = std::move(effects);
    return options;
  }
  void run(long steps) {
    const double begin = cpuSeconds();
    for (long i = 0; i < steps; ++i) {
      Action command(10);
      for (std::size_t m = 0; m < 10; ++m) command[m] = 0.3 + 0.1 * study::wave(0.5 + 0.05 * static_cast<double>(m), simulation.time_s());
      simulation.robot().step(command);
      simulation.robot().getState();
      simulation.step();
    }
    best_s = std::min(best_s, (cpuSeconds() - begin) / static_cast<double>(steps));
  }
  /// CPU time of the stages alone, per control step.
  void callStages() {
    constexpr int count = 2000;
    EffectChain& effects = simulation.effects();
    const double h_s = simulation.internalStepS(), begin = cpuSeconds();
    for (int i = 0; i < count; ++i) {
      effects.command(h_s);
      effects.pressure(h_s);
      effects.force(h_s);
      effects.body(h_s);
      effects.track(h_s);
    }
    stages_s = std::min(stages_s, (cpuSeconds() - begin) / count * simulation.substeps());
  }
};

}  // namespace

int main(int count, char** arguments) {
  constexpr long steps = 20;
  constexpr int repeats = 15;
  Simulation probe;
  const Robot& robot = probe.build("arm");
  std::vector<std::unique_ptr<Arm>> arms;
  arms.push_back(std::make_unique<Arm>(std::vector<ActiveEffect>{}));
  constexpr Stage stages[] = {Stage::command, Stage::pressure, Stage::force, Stage::body, Stage::sensor};
  for (const Stage stage : stages) arms.push_back(std::make_unique<Arm>(allOf(stage, robot)));
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (auto& arm : arms) {
      arm->simulation.start("built", Action(10, 0.3));
      arm->run(steps);
      arm->callStages();
    }
  std::string table = "| stage | effects | time of a step over that without effects | calls alone, share of a step |\n|---|---|---|---|\n";
  for (std::size_t i = 0; i < 5; ++i)
    table += fmt::format("| {} | {} | {:.3f} | {:.1f} % |\n", nameOf(stages[i]), arms[i + 1]->simulation.effects().active().size(),
                         arms[i + 1]->best_s / arms[0]->best_s, 100 * (arms[i + 1]->stages_s - arms[0]->stages_s) / arms[0]->best_s);
  if (count == 3 && std::strcmp(arguments[1], "--document") == 0)
    writeSection(arguments[2], "cost", "effect_cost", table);
  else
    fmt::print("{}", table);
}
