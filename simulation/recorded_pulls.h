/// Pulls of a run in its sidecar, so that a replay repeats them.
///
///     "pulls": [{"time_s": 1.2, "part": 4, "point_mm": [0, 0, 9], "towards_mm": [-200, 30, 40]}, {"time_s": 2.5}]
/// Each holds until the next one; one without a part lets go.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "musclesim/controller/hands.h"
#include "musclesim/log/recording.h"

namespace musclesim {

struct TimedPull {
  double time_s;
  std::optional<Pull> pull;
};

/// The pulls among the inputs of a run with this control step.
std::vector<TimedPull> pullsOf(const InputHistory& history, double step_s);
/// The value of "pulls".
std::string toJson(const std::vector<TimedPull>& pulls);
/// The pulls that a recording tells of. Throws BadFile, with `source` as its name, if they cannot be read.
std::vector<TimedPull> recordedPulls(const RecordingInfo& info, const std::string& source);

}  // namespace musclesim
