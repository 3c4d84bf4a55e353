#include "time_line.h"

#include <algorithm>

namespace musclesim {

namespace {

constexpr float side_px = 14, line_px = 14, below_px = 12, reach_px = 8;
const Color base_color{1, 1, 1, ""}, past_color{0.62, 0.66, 0.72, ""}, mark_color{0.90, 0.45, 0.05, ""}, cursor_color{0.10, 0.11, 0.13, ""};

}  // namespace

TimeLine TimeLine::in(float scene_width, float scene_height) {
  return {side_px, scene_height - below_px - line_px, std::max(1.0F, scene_width - 2 * side_px), line_px};
}

bool TimeLine::contains(float x, float y) const {
  return x >= left - reach_px && x <= left + width + reach_px && y >= top - reach_px && y <= top + height + reach_px;
}

float TimeLine::xOf(const Player& player, double time_s) const {
  const double duration_s = player.endS() - player.beginS();
  return left + width * static_cast<float>(duration_s > 0 ? (time_s - player.beginS()) / duration_s : 0);
}

double TimeLine::timeAt(const Player& player, float x) const {
  const auto share = static_cast<double>(std::clamp((x - left) / width, 0.0F, 1.0F));
  return player.beginS() + share * (player.endS() - player.beginS());
}

void drawTimeLine(Painter& painter, const Player& player, const TimeLine& line) {
  constexpr float smallest_mark_px = 2, cursor_px = 3, overhang_px = 5;
  painter.rectangle(line.left, line.top, line.width, line.height, base_color, 0.9F);
  const float now = line.xOf(player, player.timeS());
  painter.rectangle(line.left, line.top, now - line.left, line.height, past_color, 0.6F);
  for (const auto& [from_s, to_s] : player.outsideS()) {
    const float from = line.xOf(player, from_s), to = line.xOf(player, to_s);
    painter.rectangle(from, line.top + line.height / 2, std::max(smallest_mark_px, to - from), line.height / 2, mark_color, 1);
  }
  painter.rectangle(now - cursor_px / 2, line.top - overhang_px, cursor_px, line.height + 2 * overhang_px, cursor_color, 1);
}

}  // namespace musclesim
