#include <fmt/format.h>

#include <cmath>

#include "musclesim/base/error.h"
#include "pictures.h"

namespace musclesim::command_line {

void addPictureOptions(CLI::App& command, PictureOptions& options, const std::string& group) {
  command.add_option("--screenshot", options.screenshot, "Picture of the last state, FILE.png; needs no display")->group(group);
  command.add_option("--video", options.video, "Video, FILE.mp4 (without ffmpeg: pictures in the folder FILE-frames); needs no display")
      ->group(group);
  command.add_option("--picture-size", options.size_px, "Width and height in pixels, WxH")->group(group)->delimiter('x')->expected(2);
  command.add_option("--camera", options.camera, "Azimuth and elevation in degrees, distance in mm: A,E,D")
      ->group(group)
      ->delimiter(',')
      ->expected(3);
  command.add_flag("--arrows", options.arrows, "Show contacts and the tensions of muscles as arrows")->group(group);
  command.add_option("--speed", options.speed, "Simulated seconds per second of window or video (default 1; 10 in original physics)")
      ->group(group);
}

void PictureOptions::requireUsed(const std::string& why) const {
  const bool asks_for_view = arrows || !camera.empty() || size_px != PictureOptions().size_px;
  if (asks_for_view && !wanted())
    throw BadParameter(fmt::format("--arrows, --camera and --picture-size need a window, --screenshot or --video, but {}", why));
  if (speed && !video) throw BadParameter(fmt::format("--speed needs a window or --video, but {} and there is no --video", why));
}

double speedRatio(const PictureOptions& options, const PhysicsSettings& physics) {
  constexpr double original = 10;
  const double speed = options.speed.value_or(physics.kind == PhysicsKind::original ? original : 1.0);
  if (!(speed >= 1e-3 && speed <= 1e4)) throw BadParameter("speed", fmt::format("{}", speed), "lie in 0.001 .. 10000");
  return speed;
}

}  // namespace musclesim::command_line
