/// Observers of a running simulation.
#pragma once

#include <optional>
#include <string>

#include "musclesim/robot/state.h"

namespace musclesim::command_line {

/// Sees every control step of a run and changes nothing: a run gives the same bits with and without it.
class Spectator {
 public:
  virtual ~Spectator() = default;
  /// Gets the readings of each control step, in order of time, including the first and the last. Returns false to end the run.
  virtual bool see(const State& state) = 0;
  /// The reason if a failure of its own made it end the run.
  virtual std::optional<std::string> failure() const { return std::nullopt; }
  /// Called if the run diverged, before finish().
  virtual void diverge(const std::string& message) { static_cast<void>(message); }
  /// Called after the run; the simulation may no longer exist.
  virtual void finish() = 0;
};

}  // namespace musclesim::command_line
