#include "window.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "interrupt.h"
#include "musclesim/controller/controller_registry.h"
#include "musclesim/robot/robot_registry.h"
#include "simulation/display/display.h"
#include "view.h"

namespace musclesim::command_line {

namespace {

namespace fs = std::filesystem;

/// The registered robots, then the files of the folder `robots`.
std::vector<std::string> robotsToChoose() {
  std::vector<std::string> names, files;
  for (const auto& [name, description] : registeredRobots()) names.push_back(name);
  std::error_code no_folder;
  for (const auto& entry : fs::directory_iterator("robots", no_folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  std::ranges::sort(files);
  names.insert(names.end(), files.begin(), files.end());
  return names;
}

/// Shows the states that it sees and waits between them as the user of the window demands.
class WindowSpectator final : public RunWindow {
 public:
  WindowSpectator(const PictureOptions& options, const std::string& log_file) : options_(options), log_file_(log_file) {}

  void begin(ShownRun run, Simulation& simulation, const State& first, const std::string& folder) override {
    const std::string& robot = simulation.robot().name();
    hands_ = run.hands;
    run.title = fmt::format("musclesim: {}, seed {}", robot, simulation.seed());
    snapshots_.emplace(simulation);
    Snapshot snapshot = snapshots_->take(first);
    run.camera = initialCamera(robot, snapshot, options_.camera);
    if (display_)
      display_->begin(std::move(run), std::move(snapshot));
    else
      display_ = std::make_unique<Display>(displayOptions(run, simulation, folder), std::move(run), std::move(snapshot));
  }

  bool see(const State& state) override {
    if (!hands_->isRepeating()) return display_->show(snapshots_->take(state), isInterrupted);
    constexpr auto between_pictures = std::chrono::milliseconds(40);
    const auto now = std::chrono::steady_clock::now();
    if (now - shown_at_ < between_pictures) return true;
    shown_at_ = now;
    return display_->showAtOnce(snapshots_->take(state), isInterrupted);
  }
  std::optional<std::string> failure() const override { return display_->loss(); }
  void diverge(const std::string& message) override { display_->showDivergence(message, isInterrupted); }
  void finish() override {}
  std::optional<RunRequest> takeRequest() override { return display_->takeRequest(); }
  bool isAsked() const override { return display_->isAsked(); }
  void say(const std::string& message) override { display_->say(message); }

 private:
  static bool isInterrupted() { return interruptSignal() != 0; }

  DisplayOptions displayOptions(const ShownRun& run, Simulation& simulation, const std::string& folder) const {
    DisplayOptions result;
    result.title = run.title;
    result.width_px = options_.size_px.at(0);
    result.height_px = options_.size_px.at(1);
    result.speed_ratio = speedRatio(options_, simulation.physics());
    result.camera = run.camera;
    result.arrows = options_.arrows;
    result.robots = robotsToChoose();
    result.controllers = registeredControllers();
    result.picture_folder = folder;
    result.log_file = log_file_;
    return result;
  }

  const PictureOptions options_;
  const std::string log_file_;
  std::shared_ptr<Hands> hands_;
  std::optional<SnapshotTaker> snapshots_;
  std::unique_ptr<Display> display_;
  std::chrono::steady_clock::time_point shown_at_;
};

}  // namespace

std::unique_ptr<RunWindow> makeRunWindow(const PictureOptions& options, const std::string& log_file) {
  return std::make_unique<WindowSpectator>(options, log_file);
}

}  // namespace musclesim::command_line
