/// The project's own golden trajectories: rig and elbow in `si`, with new pressures every 0.1 s.
#pragma once

#include <string>

#include "musclesim/log/recording.h"
#include "musclesim/simulation/replay.h"

namespace musclesim {

/// Commands of a golden trajectory, without measured signals.
inline Recording goldenCommands(const std::string& robot) {
  constexpr int row_count = 61;
  const std::vector<std::vector<double>> levels =
      robot == "rig" ? std::vector<std::vector<double>>{{0.5, 0.8, 0.2, 0.6, 1, 0.4}}
                     : std::vector<std::vector<double>>{{0.5, 0.7, 0.3, 0.9, 0.4, 0.5}, {0.5, 0.4, 0.6, 0.2, 0.4, 0.8}};
  Recording recording;
  recording.info.robot = robot;
  recording.info.physics = "si";
  recording.info.initial_state = "settled";
  recording.info.step_s = 0.01;
  for (std::size_t muscle = 0; muscle < levels.size(); ++muscle) {
    recording.signals.push_back({"command_" + std::to_string(muscle), {}});
    for (int row = 0; row < row_count; ++row)
      recording.signals.back().values.push_back(levels[muscle][static_cast<std::size_t>(std::min(row / 10, 5))]);
  }
  for (int row = 0; row < row_count; ++row) recording.time_s.push_back(row / 100.0);
  return recording;
}

/// Options of the golden trajectories. Internal steps of 2 ms keep the test short.
inline ReplayOptions goldenOptions(StepperKind stepper) {
  ReplayOptions options;
  options.stepper = stepper;
  options.substeps = 5;
  return options;
}

}  // namespace musclesim
