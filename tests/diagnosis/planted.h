/// Rigs with a planted effect and noise; candidates are few to keep the tests short.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "musclesim/base/random.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/replay.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim::planted {

constexpr double noise_mm = 0.05, pressure_noise = 0.0025;

enum class Pressure { left_out, measured };

/// What a rig with these effects measures under the commands of a plan: its length, and its pressure if asked for.
inline Recording measuredUnder(const std::vector<ActiveEffect>& effects, const Recording& plan, std::uint64_t seed,
                               Pressure pressure = Pressure::left_out) {
  ReplayOptions options;
  options.effects = effects;
  Recording recording = replayRecording(plan, options).simulated;
  recording.file = plan.file;
  recording.info.active_effects.clear();
  recording.info.noise_std = {{"length_0_mm", noise_mm}};
  if (pressure == Pressure::measured) recording.info.noise_std["pressure_0"] = pressure_noise;
  const auto& noise = recording.info.noise_std;
  std::erase_if(recording.signals, [&](const Signal& s) { return s.name != "command_0" && !noise.contains(s.name); });
  for (Signal& signal : recording.signals) {
    if (signal.name == "command_0") continue;
    RandomStream random(seed, signal.name == "length_0_mm" ? "planted" : "planted pressure");
    for (double& value : signal.values) value += noise.at(signal.name) * random.normal();
  }
  return recording;
}

/// The same under steps and a wave, 4 s.
inline Recording recorded(const std::vector<ActiveEffect>& effects, double amplitude, std::uint64_t seed,
                          Pressure pressure = Pressure::left_out) {
  Recording plan;
  plan.file = "plan_" + std::to_string(seed) + ".csv";
  plan.info.robot = "rig";
  plan.signals = {{"command_0", {}}};
  for (int row = 0; row < 400; ++row) {
    const double t = 0.01 * row;
    plan.time_s.push_back(t);
    const double step = std::fmod(t, 1.0) < 0.5 ? 1 : -1;
    plan.signals[0].values.push_back(0.45 + amplitude * (t < 2 ? step : std::sin(2 * std::numbers::pi * t)));
  }
  return measuredUnder(effects, plan, seed, pressure);
}

inline std::vector<Recording> plant(const std::vector<ActiveEffect>& effects, Pressure pressure = Pressure::left_out) {
  return {recorded(effects, 0.15, 1, pressure), recorded(effects, 0.2, 2, pressure)};
}

/// The same recordings with sidecars that say that every number of the model is known to a millionth, whatever the robot's file says.
inline std::vector<Recording> withExactModel(std::vector<Recording> recordings) {
  Simulation simulation;
  simulation.build(recordings.front().info.robot);
  for (Recording& recording : recordings)
    for (const auto& [name, tolerance] : simulation.robot().parameterTolerances()) recording.info.parameter_tolerance[name] = 1e-6;
  return recordings;
}

inline DiagnosisOptions few(const std::vector<std::string>& candidates) {
  DiagnosisOptions options;
  options.candidates = candidates;
  options.job_count = 2;
  return options;
}

}  // namespace musclesim::planted
