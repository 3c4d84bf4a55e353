#include "overlay.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <sstream>

#include "time_line.h"

namespace musclesim {

std::string paceLine(const Console& console) {
  const double target = console.pace().speed(), measured = console.pace().measuredSpeed();
  return fmt::format("x real time: target {:.3g}, measured {}", target, measured > 0 ? fmt::format("{:.3g}", measured) : "-");
}

std::vector<std::string> replayLines(const Console& console, const Snapshot& snapshot) {
  const Player& player = *console.player();
  std::vector<std::string> lines = {!player.hasEffects()   ? "simulated: the model as it is"
                                    : player.withEffects() ? "simulated: with the effects (e)"
                                                           : "simulated: without the effects (e)"};
  if (!player.hasGhost())
    lines.push_back("no measured pose: " + player.ghostSource());
  else
    lines.push_back("measured (blue): " + player.ghostSource() + (console.style.ghost ? "" : ", hidden (g)"));
  if (const auto distance_mm = distanceOfGhostMm(snapshot)) lines.push_back(fmt::format("distance of the poses: {:.1f} mm", *distance_mm));
  if (const ReplayGap* gap = player.gap())
    lines.push_back(fmt::format("{}: residual {:.2g}, noise {:.2g}", gap->name, gap->rmse(), gap->noise_sigma));
  return lines;
}

namespace {

const Color ink{0.13, 0.14, 0.16, ""}, paper{1, 1, 1, ""}, night{0.10, 0.11, 0.13, ""}, accent{1, 0.80, 0.35, ""},
    alarm{0.72, 0.08, 0.06, ""};
constexpr float margin = 12;

float boxHeight(const Painter& painter, const std::vector<std::string>& lines) {
  return painter.lineHeight() * static_cast<float>(lines.size()) + margin;
}

/// Draws lines of text in a box.
void drawBox(Painter& painter, float x, float y, const std::vector<std::string>& lines, const Color& text, const Color& box, float alpha) {
  float width = 0;
  for (const std::string& line : lines) width = std::max(width, painter.widthOf(line));
  const float line = painter.lineHeight();
  painter.rectangle(x, y, width + 2 * margin, boxHeight(painter, lines), box, alpha);
  for (std::size_t i = 0; i < lines.size(); ++i) painter.text(x + margin, y + margin / 2 + line * static_cast<float>(i), lines[i], text);
}

std::vector<std::string> statusLines(const Console& console, const Snapshot& snapshot) {
  const State& state = snapshot.state;
  std::vector<std::string> lines = {fmt::format("{:.2f} s   {}", state.time_s, console.pace().isPaused() ? "paused" : "running")};
  if (console.player()) {
    lines.front() += fmt::format(", speed {:.3g}", console.pace().speed());
    const std::vector<std::string> of_replay = replayLines(console, snapshot);
    lines.insert(lines.end(), of_replay.begin(), of_replay.end());
  } else {
    lines.front() += console.hands().isManual() ? ", by hand" : ", automatic";
    lines.push_back(paceLine(console));
  }
  if (state.hand_mm)
    lines.push_back(fmt::format("hand {:.0f}, {:.0f}, {:.0f} mm", state.hand_mm->x(), state.hand_mm->y(), state.hand_mm->z()));
  const auto muscle = static_cast<std::size_t>(console.selected());
  if (console.selected() >= 0 && muscle < state.pressure.size())
    lines.push_back(fmt::format("muscle {}: pressure {:.2f}, length {:.1f} mm, force {:.1f} N", muscle, state.pressure[muscle],
                                state.length_mm[muscle], state.force_N[muscle]));
  return lines;
}

/// Draws names beside points; a name that would cover another one moves down.
class Labels {
 public:
  Labels(Painter& painter, const Camera& camera, float width, float height)
      : painter_(painter), camera_(camera), width_(width), height_(height) {}

  void add(const Eigen::Vector3f& point, const std::string& text, const Color& color) {
    const auto at = camera_.pixelOf(point, width_, height_);
    if (!at) return;
    const float w = painter_.widthOf(text) + 8, h = painter_.lineHeight();
    Eigen::Vector2f corner(at->x() + 6, at->y() - h / 2);
    while (std::any_of(taken_.begin(), taken_.end(), [&](const Eigen::AlignedBox2f& box) {
      return box.intersects({corner, Eigen::Vector2f(corner.x() + w, corner.y() + h)});
    }))
      corner.y() += h / 2;
    taken_.emplace_back(corner, Eigen::Vector2f(corner.x() + w - 1, corner.y() + h - 1));
    painter_.rectangle(corner.x(), corner.y(), w, h, paper, 0.75F);
    painter_.text(corner.x() + 4, corner.y(), text, color);
  }

 private:
  Painter& painter_;
  const Camera& camera_;
  float width_, height_;
  std::vector<Eigen::AlignedBox2f> taken_;
};

void drawLabels(Painter& painter, const Console& console, const Snapshot& snapshot, float width, float height) {
  Labels labels(painter, console.camera, width, height);
  if (snapshot.pull) labels.add(snapshot.pull->towards_mm, fmt::format("{:.1f} N", snapshot.pull->force_N), ink);
  if (!console.style.frames) return;
  for (const DrawnFrame& frame : snapshot.frames) labels.add(frame.pose.topRightCorner<3, 1>(), frame.name, ink);
  for (std::size_t i = 0; i < snapshot.hoses.size(); ++i) {
    const auto& points = snapshot.hoses[i].points_mm;
    labels.add((points[(points.size() - 1) / 2] + points[points.size() / 2]) / 2, std::to_string(i),
               static_cast<int>(i) == console.selected() ? alarm : ink);
  }
}

void drawHelp(Painter& painter, const Console& console, float width, float height) {
  const auto& bindings = console.bindings();
  std::vector<std::pair<std::string, std::string>> rows = {{"drag", "rotate (left button), move (right or middle button)"},
                                                           {"click", "select the muscle under the pointer"}};
  if (!console.player()) rows.emplace_back("Ctrl + drag", "pull at a bone, or move the target");
  if (console.player()) rows.emplace_back("time line", "click or drag to go to another time");
  for (const auto& binding : bindings) rows.emplace_back(binding.keys, binding.meaning);
  float keys_width = 0, meanings_width = 0;
  for (const auto& [keys, meaning] : rows) {
    keys_width = std::max(keys_width, painter.widthOf(keys));
    meanings_width = std::max(meanings_width, painter.widthOf(meaning));
  }
  const float line = painter.lineHeight() + 5, gap = 24, edge = 22;
  const float box_width = keys_width + gap + meanings_width + 2 * edge;
  const float box_height = line * static_cast<float>(rows.size() + 1) + 2 * edge;
  const float x = std::max(0.0F, (width - box_width) / 2), y = std::max(0.0F, (height - box_height) / 2);
  painter.rectangle(x, y, box_width, box_height, night, 0.90F);
  painter.text(x + edge, y + edge - 4, "Keys and mouse", paper);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const float row_y = y + edge + line * static_cast<float>(i + 1);
    painter.text(x + edge, row_y, rows[i].first, accent);
    painter.text(x + edge + keys_width + gap, row_y, rows[i].second, paper);
  }
}

/// Breaks a text into lines no wider than `width`.
std::vector<std::string> wrapped(const Painter& painter, const std::string& text, float width) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (painter.widthOf(longer) <= width || lines.back().empty())
      lines.back() = longer;
    else
      lines.push_back(word);
  }
  return lines;
}

/// Its last line stands at `bottom_line`, so that a long notice grows upwards.
void drawNotice(Painter& painter, const std::string& notice, float width, float bottom_line) {
  const std::vector<std::string> lines = wrapped(painter, notice, width - 4 * margin);
  float widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, painter.widthOf(line));
  const float top = bottom_line - painter.lineHeight() * static_cast<float>(lines.size() - 1);
  drawBox(painter, (width - widest) / 2 - margin, top, lines, paper, night, 0.80F);
}

void drawBanner(Painter& painter, const Console& console, float width, float y) {
  const char* what_now = console.player()
                             ? "The simulation ends here; the recording goes on."
                             : "The run has stopped; its recording holds everything up to here. Home begins anew, b goes back, q closes.";
  std::vector<std::string> lines;
  for (const std::string& text : {*console.divergence, std::string(what_now)})
    for (const std::string& line : wrapped(painter, text, width - 6 * margin)) lines.push_back(line);
  drawBox(painter, 2 * margin, y, lines, paper, alarm, 0.92F);
}

}  // namespace

void drawOverlay(Painter& painter, const Console& console, const Snapshot& snapshot, float width, float height, bool with_status) {
  const float line = painter.lineHeight();
  const float whole_height = height;
  if (console.player()) {  // everything else stands above the time line
    const TimeLine time_line = TimeLine::in(width, height);
    drawTimeLine(painter, *console.player(), time_line);
    height = time_line.top;
  }
  if (console.divergence) drawBanner(painter, console, width, 2 * margin);
  if (console.show_help) return drawHelp(painter, console, width, whole_height);  // nothing shines through its box
  drawLabels(painter, console, snapshot, width, whole_height);
  const float notice_top = height - 3 * line - margin;
  if (with_status) {
    const std::vector<std::string> lines = statusLines(console, snapshot);
    const float notice_lines = static_cast<float>(wrapped(painter, console.notice(), width - 4 * margin).size());
    const float bottom = notice_top - line * (notice_lines - 1);
    drawBox(painter, margin, bottom - margin - boxHeight(painter, lines), lines, ink, paper, 0.78F);
  }
  if (const std::string notice = console.notice(); !notice.empty()) drawNotice(painter, notice, width, notice_top);
  painter.text(margin, height - line - margin / 2, "h: keys", ink);
}

}  // namespace musclesim
