#include "musclesim/controller/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double time_tolerance_s = 1e-6;

std::string nameOf(const Recording& recording) {
  return recording.file.empty() ? "recording" : recording.file;
}

void requireTimes(const Recording& recording) {
  const auto& time = recording.time_s;
  if (time.empty()) throw BadFile(nameOf(recording), "there are no rows to replay");
  // Written so that NaN fails too.
  for (std::size_t row = 0; row < time.size(); ++row)
    if (!std::isfinite(time[row]) || (row > 0 && !(time[row] > time[row - 1])))
      throw BadFile(nameOf(recording),
                    fmt::format("time_s = {} s in row {}: must be finite and later than the row before", time[row], row + 1));
}

const Signal& requireCommand(const Recording& recording, int muscle) {
  const std::string name = fmt::format("command_{}", muscle);
  const Signal* command = recording.find(name);
  if (!command || command->values.size() != recording.time_s.size())
    throw BadFile(nameOf(recording), fmt::format("there is no complete {}; the robot has a muscle of that number", name));
  for (std::size_t row = 0; row < command->values.size(); ++row)
    if (const double value = command->values[row]; !(value >= 0 && value <= 1))
      throw BadFile(nameOf(recording), fmt::format("{} = {} at {} s: must lie in 0 .. 1", name, value, recording.time_s[row]));
  return *command;
}

}  // namespace

ReplayController::ReplayController(const Recording& recording, int muscle_count) : time_s_(recording.time_s) {
  requireTimes(recording);
  if (recording.find(fmt::format("command_{}", muscle_count)))
    throw BadFile(nameOf(recording), fmt::format("there are commands for more than the {} muscles of the robot", muscle_count));
  rows_.resize(time_s_.size());
  for (int muscle = 0; muscle < muscle_count; ++muscle) {
    const Signal& command = requireCommand(recording, muscle);
    for (std::size_t row = 0; row < rows_.size(); ++row) rows_[row].push_back(command.values[row]);
  }
}

Action ReplayController::output(const State& state) {
  const auto later = std::upper_bound(time_s_.begin(), time_s_.end(), state.time_s + time_tolerance_s);
  const auto row = std::max<std::ptrdiff_t>(later - time_s_.begin() - 1, 0);
  return rows_[static_cast<std::size_t>(row)];
}

}  // namespace musclesim
