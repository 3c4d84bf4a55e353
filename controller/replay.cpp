#include "musclesim/controller/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/log/csv.h"

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

Recording readCommands(const std::string& csv_file) {
  if (std::filesystem::exists(sidecarPath(csv_file))) return readRecording(csv_file);
  const std::string sidecar = R"({"format": "musclesim-recording-1", "robot": "of the table"})";
  return parseRecording(readTextFile(csv_file, CsvLimits().file_bytes), csv_file, sidecar, sidecarPath(csv_file));
}

namespace {

Recording commandsOf(const ControllerRequest& request) {
  if (request.commands_file.empty())
    throw BadParameter("controller schedule plays a file: name a recording or a table of commands with --commands FILE.csv");
  return readCommands(request.commands_file);
}

}  // namespace

ReplayController::ReplayController(const ControllerRequest& request)
    : ReplayController(commandsOf(request), request.muscle_count, request.interpolate) {
  step_s_ = request.step_s;
}

ReplayController::ReplayController(const Recording& recording, int muscle_count, bool interpolate)
    : time_s_(recording.time_s), interpolate_(interpolate) {
  requireTimes(recording);
  if (recording.find(fmt::format("command_{}", muscle_count)))
    throw BadFile(nameOf(recording), fmt::format("there are commands for more than the {} muscles of the robot", muscle_count));
  const auto count = static_cast<std::size_t>(muscle_count);
  rows_.assign(time_s_.size(), Action(count));
  for (std::size_t muscle = 0; muscle < count; ++muscle) {
    const Signal& command = requireCommand(recording, static_cast<int>(muscle));
    for (std::size_t row = 0; row < rows_.size(); ++row) rows_[row][muscle] = command.values[row];
  }
}

Action ReplayController::output(const State& state) {
  const auto later = std::upper_bound(time_s_.begin(), time_s_.end(), state.time_s + time_tolerance_s);
  const auto row = static_cast<std::size_t>(std::max<std::ptrdiff_t>(later - time_s_.begin() - 1, 0));
  Action action = rows_[row];
  const double since_s = state.time_s - time_s_[row];
  if (!interpolate_ || row + 1 == rows_.size() || since_s <= time_tolerance_s) return action;
  const double share = since_s / (time_s_[row + 1] - time_s_[row]);
  for (std::size_t i = 0; i < action.size(); ++i) action[i] = std::clamp(action[i] + share * (rows_[row + 1][i] - action[i]), 0.0, 1.0);
  return action;
}

std::vector<std::string> ReplayController::notes() const {
  std::vector<std::string> notes;
  if (time_s_.front() > step_s_ + time_tolerance_s)
    notes.push_back(fmt::format("the commands begin at {:g} s; their first row holds until then", time_s_.front()));
  long skipped = 0;  // rows that end before the next control step
  for (std::size_t row = 0; row + 1 < time_s_.size() && step_s_ > 0; ++row)
    skipped += std::ceil((time_s_[row] - time_tolerance_s) / step_s_) * step_s_ > time_s_[row + 1] - time_tolerance_s;
  if (skipped > 0 && !interpolate_)
    notes.push_back(
        fmt::format("warning: {} of {} rows of the commands lie between two control steps of {:g} s and are never commanded; a "
                    "smaller --step plays them",
                    skipped, time_s_.size(), step_s_));
  return notes;
}

}  // namespace musclesim
