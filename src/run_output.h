/// Outputs of a run: its folder, the contents of the sidecar, the listing of --verbose, the score of a task.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"
#include "musclesim/simulation/simulation.h"
#include "pictures.h"

namespace musclesim::command_line {

/// The options of `run` except the model options.
struct RunOptions {
  bool simple = false, verbose = false, print_config = false, overwrite = false;
  std::optional<std::string> controller;  ///< defaultController() if not given
  std::optional<std::string> task;        ///< "height" if not given
  std::optional<std::string> commands, interpolate, channels, targets, against;
  std::vector<std::string> record_signals, figure_signals, summarise;
  std::vector<double> target_mm;
  std::optional<double> decision_interval_s, record_interval_s;
  std::optional<double> duration_s;
  std::optional<std::string> record, out, window_log;
  PictureOptions pictures;
  bool only_record = false;  ///< no figure, nothing on standard output: for `rerun`
};

/// The controller of a run that names none.
std::string defaultController(const Robot& robot, const RunOptions& options);

/// The path of the recording: --record, or run.csv in --out, or run.csv in a fresh folder log/runs/<date-time>-<label>-<seed>. The label is
/// the task if there is one, else robot and controller. Throws BadParameter for a name that does not end in .csv.
std::filesystem::path recordingPath(const RunOptions& options, Simulation& simulation);

/// The sidecar of a run: robot, physics, seed, every parameter. `options` name the controller; `origin` is for the member "run".
RecordingInfo describe(Simulation& simulation, const RunOptions& options, const std::string& initial_state, const nlohmann::json& origin);

/// The paper's --verbose: all primitives and actuators, on standard output.
void list(Simulation& simulation);

/// How well a target is reached over a run.
class Score {
 public:
  void add(double time_s, const State& state, const Controller& controller);
  /// Members final_error_mm, reached_within_mm, reached_at_s (null: never), held_share (of the time since); empty without a target.
  nlohmann::json verdict() const;

 private:
  static constexpr double near_mm = 20;
  std::optional<double> error_mm_, reached_at_s_;
  long samples_since_ = 0, near_since_ = 0;
};

}  // namespace musclesim::command_line
