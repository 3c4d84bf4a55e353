#include "console.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

namespace musclesim {

namespace {

constexpr double hundred = 100, pressure_step_ratio = 1 / hundred;
constexpr float zoom_step = 1.1F;
constexpr double speed_step = 2;

void changeSpeed(Console& console, double factor) {
  console.pace().setSpeed(console.pace().speed() * factor);
  console.say(fmt::format("speed {:g}", console.pace().speed()));
}

void flip(Console& console, bool& which, const char* name) {
  which = !which;
  console.say(fmt::format("{} {}", name, which ? "on" : "off"));
}

std::vector<int> digits() {
  std::vector<int> codes;
  for (int code = '0'; code <= '9'; ++code) codes.push_back(code);
  return codes;
}

}  // namespace

const std::vector<Console::Binding>& Console::bindings() {
  static const std::vector<Binding> all = {
      {"i", "muscles automatic or by hand", {'i'}, [](Console& c, int) { c.toggleManual(); }},
      {"p  Space", "pause, resume", {'p', ' '}, [](Console& c, int) { c.pace().setPaused(!c.pace().isPaused()); }},
      {"Right", "do one step, then pause", {key::right}, [](Console& c, int) { c.pace().stepOnce(); }},
      {"[  ]", "slower, faster", {'[', ']'}, [](Console& c, int code) { changeSpeed(c, code == '[' ? 1 / speed_step : speed_step); }},
      {"0 - 9", "select a muscle", digits(), [](Console& c, int code) { c.select(code - '0'); }},
      {",  .", "previous, next muscle", {',', '.'}, [](Console& c, int code) { c.select(c.selected() + (code == ',' ? -1 : 1)); }},
      {"+  -",
       "pressure of the selected muscle",
       {'+', '=', '-', '_'},
       [](Console& c, int code) { c.raise(code == '+' || code == '=' ? pressure_step_ratio : -pressure_step_ratio); }},
      {"r",
       "vent all muscles",
       {'r'},
       [](Console& c, int) {
         c.hands().reset();
         c.say("all pressures 0, by hand");
       }},
      {"Up  Down",
       "zoom in, out (also the wheel)",
       {key::up, key::down},
       [](Console& c, int code) { c.camera.zoom(code == key::up ? zoom_step : 1 / zoom_step); }},
      {"c", "reset the view", {'c'}, [](Console& c, int) { c.camera = c.first_camera_; }},
      {"t", "transparent bones", {'t'}, [](Console& c, int) { flip(c, c.style.transparent, "transparent bones"); }},
      {"m", "colour muscles by tension", {'m'}, [](Console& c, int) { flip(c, c.style.color_tension, "colours by tension"); }},
      {"f", "frames and labels", {'f'}, [](Console& c, int) { flip(c, c.style.frames, "frames and labels"); }},
      {"s", "save a picture in the run's folder", {'s'}, [](Console& c, int) { c.wants_screenshot = true; }},
      {"v", "start or stop a video in the run's folder", {'v'}, [](Console& c, int) { c.wants_video = !c.wants_video; }},
      {"Tab", "show or hide the panel", {key::tab}, [](Console& c, int) { c.show_panel = !c.show_panel; }},
      {"h  F1", "this help", {'h', key::f1}, [](Console& c, int) { c.show_help = !c.show_help; }},
      {"q  Esc", "end the run", {'q', key::escape}, [](Console& c, int) { c.pace().close(); }},
  };
  return all;
}

Console::Console(ManualController& hands, Pace& pace, const Camera& first)
    : camera(first), hands_(hands), pace_(pace), first_camera_(first), muscle_count_(static_cast<int>(hands.pressures().size())) {}

bool Console::press(int code) {
  if (code < 128) code = std::tolower(code);
  for (const Binding& binding : bindings()) {
    if (std::find(binding.codes.begin(), binding.codes.end(), code) == binding.codes.end()) continue;
    binding.act(*this, code);
    return true;
  }
  return false;
}

void Console::select(int muscle) {
  if (muscle < 0 || muscle >= muscle_count_) return;
  style.selected = muscle;
}

/// Counts in hundredths, so that fifty steps from 0 give exactly 0.5.
void Console::raise(double by_ratio) {
  if (selected() < 0) return say("select a muscle first: 0 - 9 or a click on it");
  const double pressure = hands_.pressures()[static_cast<std::size_t>(selected())] + by_ratio;
  setPressure(selected(), std::round(pressure * hundred) / hundred);
}

void Console::setPressure(int muscle, double pressure_ratio) {
  if (!hands_.isManual()) say("muscles under manual control; press i for automatic");
  hands_.set(muscle, pressure_ratio);
}

void Console::toggleManual() {
  hands_.isManual() ? hands_.handBack() : hands_.takeOver();
  say(hands_.isManual() ? "by hand" : "automatic");
}

void Console::say(const std::string& message) {
  constexpr auto shown_for = std::chrono::seconds(4);
  notice_ = message;
  notice_until_ = std::chrono::steady_clock::now() + shown_for;
}

std::string Console::notice() const {
  return std::chrono::steady_clock::now() < notice_until_ ? notice_ : "";
}

nlohmann::json Console::state() const {
  nlohmann::json state = {{"manual", hands_.isManual()},
                          {"pressures", hands_.pressures()},
                          {"selected", style.selected},
                          {"paused", pace_.isPaused()},
                          {"closed", pace_.isClosed()},
                          {"speed", pace_.speed()},
                          {"measured_speed", pace_.measuredSpeed()},
                          {"camera",
                           {{"azimuth_deg", camera.azimuth_deg},
                            {"elevation_deg", camera.elevation_deg},
                            {"distance_mm", camera.distance_mm},
                            {"center_mm", {camera.center_mm.x(), camera.center_mm.y(), camera.center_mm.z()}}}},
                          {"transparent", style.transparent},
                          {"color_tension", style.color_tension},
                          {"frames", style.frames},
                          {"help", show_help},
                          {"panel", show_panel},
                          {"video", wants_video}};
  if (divergence) state["divergence"] = *divergence;
  return state;
}

}  // namespace musclesim
