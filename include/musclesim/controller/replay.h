/// Plays the commands of a recording or a table.
#pragma once

#include <string>
#include <vector>

#include "musclesim/controller/controller.h"
#include "musclesim/log/recording.h"

namespace musclesim {

/// Repeats the commands of a recording: each row holds from its time until the time of the next row (zero-order hold), or the commands move
/// to the next row on a straight line. The first row also holds before its time, the last after it. The clock is State::time_s. A row takes
/// effect 1 microsecond before its time, so that rounding cannot delay it by a control step. Rows are looked up by time, so calls may come
/// in any order.
///
/// In the registry it is "schedule", which plays ControllerRequest::commands_file. It keeps a copy of the commands.
class ReplayController final : public Controller {
 public:
  /// Throws BadFile unless the recording has rows at strictly increasing times and, in each, commands "command_0" to
  /// "command_<muscle_count - 1>" in 0..1 and no others.
  ReplayController(const Recording& recording, int muscle_count, bool interpolate = false);
  /// Reads the request's file of commands. Throws BadParameter if it names none, and as readCommands.
  explicit ReplayController(const ControllerRequest& request);
  Action output(const State& state) override;
  /// The time of the last row.
  std::optional<double> endS() const override { return time_s_.back(); }
  std::vector<std::string> notes() const override;

 private:
  std::vector<double> time_s_;
  std::vector<Action> rows_;
  bool interpolate_;
  double step_s_ = 0;  ///< control step, for notes; 0: not known
};

/// Reads a recording, or a table without a sidecar that has the column time_s and commands as fractions of full scale. Throws as
/// readRecording does.
Recording readCommands(const std::string& csv_file);

}  // namespace musclesim
