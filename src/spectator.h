/// Whoever looks on while a simulation runs.
#pragma once

#include <optional>
#include <string>

#include "musclesim/robot/state.h"

namespace musclesim::program {

/// Is shown every moment of a run and changes nothing in it, so that a run has the same bits with and without.
class Spectator {
 public:
  virtual ~Spectator() = default;
  /// The readings once per control step, in order of time, the first and the last included. False: the run is to end here.
  virtual bool see(const State& state) = 0;
  /// Why it ended the run, if it could not go on itself.
  virtual std::optional<std::string> failure() const { return std::nullopt; }
  /// The run has ended in a divergence; before finish().
  virtual void diverge(const std::string& message) { static_cast<void>(message); }
  /// The run is over; the simulation may be gone.
  virtual void finish() = 0;
};

}  // namespace musclesim::program
