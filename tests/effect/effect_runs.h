/// Short recordings and runs that the tests of effects share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "musclesim/effect/catalogue.h"
#include "musclesim/simulation/replay.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

/// A recording of commands over time: `command(time_s)` for every muscle of a robot.
inline Recording commandsFor(const std::string& robot, double duration_s, const std::function<Action(double)>& command,
                             double interval_s = 0.01) {
  Recording recording;
  recording.info.robot = robot;
  const Action first = command(0);
  for (std::size_t i = 0; i < first.size(); ++i) recording.signals.push_back({"command_" + std::to_string(i), {}});
  const auto rows = static_cast<long>(std::lround(duration_s / interval_s)) + 1;
  for (long row = 0; row < rows; ++row) {
    const double time_s = static_cast<double>(row) * interval_s;
    const Action action = command(time_s);
    recording.time_s.push_back(time_s);
    for (std::size_t i = 0; i < action.size(); ++i) recording.signals[i].values.push_back(action[i]);
  }
  return recording;
}

/// Slow waves, different for each muscle, and a large step after 60 % of the time.
inline Recording wavesFor(const std::string& robot, double duration_s) {
  const std::size_t count = robot == "rig" ? 1 : robot == "elbow" ? 2 : 10;
  return commandsFor(robot, duration_s, [=](double t) {
    Action action;
    for (std::size_t i = 0; i < count; ++i) {
      const double k = static_cast<double>(i);
      action.push_back(0.2 + 0.15 * std::sin(2 * std::numbers::pi * (0.8 + 0.1 * k) * t + k + 4) + (t > 0.6 * duration_s ? 0.5 : 0));
    }
    return action;
  });
}

inline ReplayResult replayWith(const Recording& recording, const std::vector<ActiveEffect>& effects, ReplayOptions options = {}) {
  options.effects = effects;
  return replayRecording(recording, options);
}

inline const std::vector<double>& valuesOf(const ReplayResult& result, const std::string& signal) {
  const Signal* found = result.simulated.find(signal);
  if (!found) throw std::runtime_error("no signal " + signal);
  return found->values;
}

/// Whether both are equal bit for bit.
inline void expectSame(const Recording& a, const Recording& b) {
  ASSERT_EQ(a.signals.size(), b.signals.size());
  for (std::size_t i = 0; i < a.signals.size(); ++i) {
    EXPECT_EQ(a.signals[i].name, b.signals[i].name);
    EXPECT_EQ(a.signals[i].values, b.signals[i].values) << a.signals[i].name;
  }
}

}  // namespace musclesim
