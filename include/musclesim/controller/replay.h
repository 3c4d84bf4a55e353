/// Plays the commands of a recording.
#pragma once

#include <vector>

#include "musclesim/controller/controller.h"
#include "musclesim/log/recording.h"

namespace musclesim {

/// Repeats the commands of a recording: each row holds from its time until the time of the next row (zero-order hold); the first row also
/// holds before its time. The clock is State::time_s. A row takes effect 1 microsecond before its time, so that rounding cannot delay it by
/// a control step. Rows are looked up by time, so calls may come in any order.
///
/// It is not in the registry, since it is built from a recording. It keeps a copy of the commands.
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
