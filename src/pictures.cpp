#include "pictures.h"

#include <fmt/format.h>

#include <filesystem>

#include "musclesim/base/error.h"
#include "output_folder.h"
#include "simulation/scene/offscreen.h"
#include "simulation/scene/video.h"
#include "view.h"

namespace musclesim::command_line {

namespace {

namespace fs = std::filesystem;

constexpr double frames_per_s = 30;

void prepareFile(const std::string& option, const std::string& file, const std::string& extension) {
  if (fs::path(file).extension() != extension) throw BadParameter(option, file, "end in " + extension);
  if (fs::path(file).has_parent_path()) makeFolder(fs::path(file).parent_path());
}

/// Draws the states that it sees.
class Pictures final : public Spectator {
 public:
  Pictures(const PictureOptions& options, Simulation& simulation, GhostOf ghost_of)
      : options_(options),
        frame_s_(speedRatio(options, simulation.physics()) / frames_per_s),
        camera_options_(options.camera),
        robot_name_(simulation.robot().name()),
        snapshots_(simulation),
        ghost_of_(std::move(ghost_of)),
        offscreen_(options.size_px.at(0), options.size_px.at(1)) {
    if (options_.screenshot) prepareFile("screenshot", *options_.screenshot, ".png");
    if (!options_.video) return;
    prepareFile("video", *options_.video, ".mp4");
    video_ = std::make_unique<VideoWriter>(*options_.video, options.size_px[0], options.size_px[1], frames_per_s);
  }

  bool see(const State& state) override {
    constexpr double rounding_s = 1e-9;
    const std::size_t index = seen_count_++;
    if (!start_s_) start_s_ = state.time_s;
    const double seen_s = state.time_s - *start_s_ + rounding_s;
    const bool frame_due = video_ && seen_s >= frameTime(video_->frameCount());
    if (!frame_due && !options_.screenshot) return true;
    last_ = snapshots_.take(state);
    if (ghost_of_) last_->ghost = ghost_of_(index, *last_);
    if (!frame_due) return true;
    const Image frame = draw(*last_);
    while (seen_s >= frameTime(video_->frameCount())) video_->add(frame);
    return true;
  }

  void finish() override {
    if (options_.screenshot && last_) {
      writePng(draw(*last_), *options_.screenshot);
      fmt::print("picture {}\n", *options_.screenshot);
    }
    if (!video_) return;
    video_->close();
    fmt::print("video   {}\n", video_->result());
  }

 private:
  double frameTime(long index) const { return static_cast<double>(index) * frame_s_; }

  Image draw(const Snapshot& snapshot) {
    if (!camera_) camera_ = initialCamera(robot_name_, snapshot, camera_options_);
    SceneStyle style;
    style.arrows = options_.arrows;
    return offscreen_.draw(snapshot, *camera_, style);
  }

  const PictureOptions options_;
  double frame_s_;
  std::vector<float> camera_options_;
  std::string robot_name_;
  SnapshotTaker snapshots_;
  GhostOf ghost_of_;
  std::size_t seen_count_ = 0;
  Offscreen offscreen_;
  std::unique_ptr<VideoWriter> video_;
  std::optional<Camera> camera_;
  std::optional<double> start_s_;  ///< time of the first state; a recording's clock can begin at any time
  std::optional<Snapshot> last_;
};

}  // namespace

std::unique_ptr<Spectator> makePictures(const PictureOptions& options, Simulation& simulation, GhostOf ghost_of) {
  return std::make_unique<Pictures>(options, simulation, std::move(ghost_of));
}

}  // namespace musclesim::command_line
