/// Plays the commands of a recording.
#pragma once

#include <vector>

#include "musclesim/controller/controller.h"
#include "musclesim/log/recording.h"

namespace musclesim {

/// Commands what was commanded in a recording, each row from its time until the time of the next (zero-order hold). Before the first row
/// the first holds, after the last row the last. Time is that of State::time_s, s; a row counts as reached from 1 microsecond before its
/// time, so that rounding in either time does not delay it by a control step. Rows are looked up by time: any order of calls is allowed.
///
/// Not in the registry, since it is made from a recording. The recording is copied as far as needed.
class ReplayController final : public Controller {
 public:
  /// Throws BadFile unless the recording has rows at strictly increasing times and, in each, commands "command_0" to
  /// "command_<muscle_count - 1>" in 0..1 and no others.
  ReplayController(const Recording& recording, int muscle_count);
  Action output(const State& state) override;

 private:
  std::vector<double> time_s_;
  std::vector<Action> rows_;
};

}  // namespace musclesim
