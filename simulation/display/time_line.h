/// The time line of a replay, at the lower edge of the scene.
#pragma once

#include "painter.h"
#include "player.h"

namespace musclesim {

struct TimeLine {
  float left, top, width, height;

  /// The one in a scene of this size.
  static TimeLine in(float scene_width_px, float scene_height_px);
  /// Whether a press there begins to scrub; a little more than what is drawn.
  bool contains(float x, float y) const;
  float xOf(const Player& player, double time_s) const;
  double timeAt(const Player& player, float x) const;
};

/// Draws the line, a mark for every interval in which the residual of the chosen signal leaves its noise band, and the present time.
void drawTimeLine(Painter& painter, const Player& player, const TimeLine& line);

}  // namespace musclesim
