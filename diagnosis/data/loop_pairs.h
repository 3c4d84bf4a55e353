/// Which signals are drawn over which as loops.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace musclesim {

/// A signal of one recording.
struct TimedSignal {
  const std::string& name;
  const std::vector<double>&time_s, &values;  ///< NaN: not measured
};

/// Indices of a pressure and of what is drawn over it: the length of each muscle over its own pressure, and each angle over the pressure
/// that goes with it most (greatest correlation, of either sign, at the times that both have). In the order of the lengths and angles.
std::vector<std::pair<std::size_t, std::size_t>> loopPairs(const std::vector<TimedSignal>& signals);

}  // namespace musclesim
