#include "window.h"

#include <fmt/format.h>

#include "interrupt.h"
#include "simulation/display/display.h"
#include "view.h"

namespace musclesim::command_line {

namespace {

/// Shows the states that it sees and waits between them as the user of the window demands.
class WindowSpectator final : public Spectator {
 public:
  WindowSpectator(const PictureOptions& options, Simulation& simulation, ManualController& hands, const State& first,
                  const std::string& folder, const std::string& log_file)
      : snapshots_(simulation), display_(displayOptions(options, simulation, folder, log_file), hands, snapshots_.take(first)) {}

  bool see(const State& state) override { return display_.show(snapshots_.take(state), isInterrupted); }
  std::optional<std::string> failure() const override { return display_.loss(); }
  void diverge(const std::string& message) override { display_.showDivergence(message, isInterrupted); }
  void finish() override {}

 private:
  static bool isInterrupted() { return interruptSignal() != 0; }

  static DisplayOptions displayOptions(const PictureOptions& options, Simulation& simulation, const std::string& folder,
                                       const std::string& log_file) {
    DisplayOptions result;
    const std::string& robot = simulation.robot().name();
    result.title = fmt::format("musclesim: {}, seed {}", robot, simulation.seed());
    result.width_px = options.size_px.at(0);
    result.height_px = options.size_px.at(1);
    result.speed_ratio = speedRatio(options, simulation.physics());
    result.camera = initialCamera(robot, SnapshotTaker(simulation).take(State{}), options.camera);
    result.picture_folder = folder;
    result.log_file = log_file;
    return result;
  }

  SnapshotTaker snapshots_;
  Display display_;
};

}  // namespace

void requireWindow() {}

std::unique_ptr<Spectator> openWindow(const PictureOptions& options, Simulation& simulation, ManualController& hands, const State& first,
                                      const std::string& folder, const std::string& log_file) {
  return std::make_unique<WindowSpectator>(options, simulation, hands, first, folder, log_file);
}

}  // namespace musclesim::command_line
