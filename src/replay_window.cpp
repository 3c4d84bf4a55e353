#include "replay_window.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "diagnosis/data/replay_gap.h"
#include "interrupt.h"
#include "musclesim/base/error.h"
#include "progress.h"
#include "simulation/display/display.h"
#include "simulation/scene/scene_error.h"
#include "view.h"

namespace musclesim::command_line {

namespace {

bool isInterrupted() {
  return interruptSignal() != 0;
}

class PosesInWindow final : public ReplayWindow {
 public:
  PosesInWindow(const Recording& recording, const ReplayOptions& options, MeasuredPoses& poses, const ReplayWindowOptions& window)
      : recording_(recording), options_(options), poses_(poses), window_(window), rows_(playedRows(recording.time_s)) {
    if (!std::getenv("DISPLAY")) throw SceneError("there is no display for a window: use --screenshot or --video for pictures");
  }

  ReplayOptions::Watcher watch(Simulation& simulation) override {
    display_.title = fmt::format("musclesim: replay of {}", std::filesystem::path(recording_.file).filename().string());
    display_.speed_ratio = speedRatio(window_.pictures, simulation.physics());
    robot_ = simulation.robot().name();
    return keep(simulation, simulated_, "simulating");
  }

  void show(const ReplayResult& result) override {
    std::vector<Trajectory> trajectories;
    if (!options_.effects.empty()) trajectories.push_back(withoutEffects());
    trajectories.push_back(completed(simulated_, result));
    if (isInterrupted()) return;
    for (const Trajectory& trajectory : trajectories)
      if (trajectory.snapshots.empty()) return;  // it diverged in its first step, which the caller reports
    std::vector<double> time_s;
    std::vector<std::shared_ptr<const DrawnGhost>> ghosts;
    const std::vector<Snapshot>& simulated = trajectories.back().snapshots;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      time_s.push_back(recording_.time_s[rows_[i]]);
      if (poses_.areDetermined()) ghosts.push_back(poses_.at(rows_[i], simulated[std::min(i, simulated.size() - 1)]));
    }
    auto player = std::make_unique<Player>(std::move(time_s), std::move(trajectories), std::move(ghosts), poses_.reason());
    display_.width_px = window_.pictures.size_px.at(0);
    display_.height_px = window_.pictures.size_px.at(1);
    display_.arrows = window_.pictures.arrows;
    display_.camera = initialCamera(robot_, *player->snapshot(), window_.pictures.camera);
    display_.picture_folder = window_.folder;
    display_.log_file = window_.log_file;
    Display display(display_, std::move(player));
    display.waitForEnd(isInterrupted);
    if (const auto loss = display.loss()) throw IoError("the window ended on its own: " + *loss);
  }

 private:
  /// Stores the snapshots of the played rows.
  ReplayOptions::Watcher keep(Simulation& simulation, Trajectory& trajectory, const std::string& what) const {
    const double begin_s = recording_.time_s.front(), duration_s = recording_.time_s.back() - begin_s;
    return [this, &trajectory, what, begin_s, row = std::size_t{0}, next = std::size_t{0},
            snapshots = std::make_shared<SnapshotTaker>(simulation),
            progress = std::make_shared<Progress>(duration_s, window_.quiet)](const State& state) mutable {
      progress->show(state.time_s - begin_s, what);
      if (next >= rows_.size() || row++ != rows_[next]) return;
      trajectory.snapshots.push_back(snapshots->take(state));
      ++next;
    };
  }

  Trajectory completed(Trajectory& trajectory, const ReplayResult& result) const {
    trajectory.gaps = replayGaps(recording_, result.simulated);
    trajectory.divergence = result.divergence;
    return std::move(trajectory);
  }

  Trajectory withoutEffects() const {
    Trajectory trajectory;
    ReplayOptions clean = options_;
    clean.effects.clear();
    clean.watch = [&](Simulation& simulation) { return keep(simulation, trajectory, "simulating without the effects"); };
    const ReplayResult result = replayRecording(recording_, clean);
    return completed(trajectory, result);
  }

  const Recording& recording_;
  const ReplayOptions options_;
  MeasuredPoses& poses_;
  const ReplayWindowOptions window_;
  const std::vector<std::size_t> rows_;
  Trajectory simulated_;
  DisplayOptions display_;
  std::string robot_;
};

}  // namespace

std::unique_ptr<ReplayWindow> makeReplayWindow(const Recording& recording, const ReplayOptions& options, MeasuredPoses& poses,
                                               const ReplayWindowOptions& window) {
  return std::make_unique<PosesInWindow>(recording, options, poses, window);
}

}  // namespace musclesim::command_line
