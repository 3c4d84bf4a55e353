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
constexpr float target_step_mm = 10;

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

using Bindings = std::vector<Console::Binding>;

/// Keys for the view, for runs and replays.
Bindings bindingsOfView() {
  return {
      {"Up  Down",
       "zoom in, out (also the wheel)",
       {key::up, key::down},
       [](Console& c, int code) { c.zoom(code == key::up ? zoom_step : 1 / zoom_step); }},
      {"c", "reset the view", {'c'}, [](Console& c, int) { c.resetView(); }},
      {"t", "transparent bones", {'t'}, [](Console& c, int) { flip(c, c.style.transparent, "transparent bones"); }},
      {"m", "colour muscles by tension", {'m'}, [](Console& c, int) { flip(c, c.style.color_tension, "colours by tension"); }},
      {"a", "arrows: tensions and contacts", {'a'}, [](Console& c, int) { flip(c, c.style.arrows, "arrows"); }},
      {"f", "frames and labels", {'f'}, [](Console& c, int) { flip(c, c.style.frames, "frames and labels"); }},
      {"s", "save a picture", {'s'}, [](Console& c, int) { c.wants_screenshot = true; }},
      {"v", "start or stop a video", {'v'}, [](Console& c, int) { c.wants_video = !c.wants_video; }},
      {"Tab", "show or hide the panel", {key::tab}, [](Console& c, int) { c.show_panel = !c.show_panel; }},
      {"h  F1", "this help", {'h', key::f1}, [](Console& c, int) { c.show_help = !c.show_help; }},
      {"q  Esc", "close the window, which ends a run", {'q', key::escape}, [](Console& c, int) { c.pace().close(); }},
  };
}

Bindings bindingsOfMuscles() {
  return {
      {"p  Space", "pause, resume", {'p', ' '}, [](Console& c, int) { c.togglePause(); }},
      {"[  ]", "slower, faster", {'[', ']'}, [](Console& c, int code) { changeSpeed(c, code == '[' ? 1 / speed_step : speed_step); }},
      {"0 - 9", "select a muscle", digits(), [](Console& c, int code) { c.select(code - '0'); }},
  };
}

Bindings joined(std::initializer_list<Bindings> parts) {
  Bindings all;
  for (const Bindings& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Goes to another row and stays there.
void goTo(Console& console, void (*move)(Player&)) {
  console.pace().setPaused(true);
  move(*console.player());
}

}  // namespace

const std::vector<Console::Binding>& Console::bindingsOfRun() {
  static const Bindings all = joined({
      {{"i", "muscles automatic or by hand", {'i'}, [](Console& c, int) { c.toggleManual(); }}},
      bindingsOfMuscles(),
      {{"Right", "do one step, then pause", {key::right}, [](Console& c, int) { c.pace().stepOnce(); }},
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
          c.keeps_in_view = true;  // without pressure it hangs down, often out of the picture
          c.say("all pressures 0, by hand");
        }},
       {"PgUp  PgDn",
        "target higher, lower",
        {key::page_up, key::page_down},
        [](Console& c, int code) { c.raiseTarget(code == key::page_up ? target_step_mm : -target_step_mm); }},
       {"k", "keep this state", {'k'}, [](Console& c, int) { c.save(); }},
       {"b", "back to the state that was kept last, then pause", {'b'}, [](Console& c, int) { c.restoreLast(); }},
       {"Home", "begin the run anew", {key::home}, [](Console& c, int) { c.resetRun(); }}},
      bindingsOfView(),
  });
  return all;
}

const std::vector<Console::Binding>& Console::bindingsOfReplay() {
  static const Bindings all = joined({
      {{"e", "simulation with or without the effects of --effects", {'e'}, [](Console& c, int) { c.toggleEffects(); }},
       {"g", "show or hide the measured pose (the ghost)", {'g'}, [](Console& c, int) { c.toggleGhost(); }}},
      bindingsOfMuscles(),
      {{"Left", "back by one row, then pause", {key::left}, [](Console& c, int) { goTo(c, [](Player& p) { p.step(-1); }); }},
       {"Right", "on by one row, then pause", {key::right}, [](Console& c, int) { goTo(c, [](Player& p) { p.step(1); }); }},
       {"Home  End",
        "to the beginning, to the end, then pause",
        {key::home, key::end},
        [](Console& c, int code) {
          c.pace().setPaused(true);
          c.player()->seek(code == key::home ? c.player()->beginS() : c.player()->endS());
        }},
       {"n",
        "to the next mark: where the residual leaves its noise band",
        {'n'},
        [](Console& c, int) {
          c.pace().setPaused(true);
          if (!c.player()->seekNextGap()) c.say("the residual of this signal nowhere leaves its noise band");
        }},
       {"l",
        "begin again at the end, or stop there",
        {'l'},
        [](Console& c, int) {
          c.player()->setLooping(!c.player()->isLooping());
          c.say(c.player()->isLooping() ? "begins again at the end" : "stops at the end");
        }},
       {",  .",
        "previous, next signal",
        {',', '.'},
        [](Console& c, int code) {
          c.player()->choose(c.player()->chosen() + (code == ',' ? -1 : 1));
          if (c.player()->gap()) c.say("marks and plots show " + c.player()->gap()->name);
        }}},
      bindingsOfView(),
  });
  return all;
}

Console::Console(std::shared_ptr<const ShownRun> run, Pace& pace)
    : camera(run->camera),
      run_(std::move(run)),
      pace_(pace),
      first_camera_(camera),
      muscle_count_(static_cast<int>(hands().pressures().size())) {}

Console::Console(Player& player, Pace& pace, const Camera& first)
    : camera(first),
      player_(&player),
      pace_(pace),
      first_camera_(first),
      muscle_count_(static_cast<int>(player.snapshot()->hoses.size())) {}

/// The view stays unless the robot is another one.
void Console::attach(std::shared_ptr<const ShownRun> run) {
  const bool is_other = run->robot != run_->robot;
  run_ = std::move(run);
  muscle_count_ = static_cast<int>(hands().pressures().size());
  first_camera_ = run_->camera;
  if (is_other) resetView();
  if (selected() >= muscle_count_) style.selected = -1;
}

void Console::resetRun() {
  wanted_run = RunRequest{run_->robot, run_->controller};
  say("from the beginning");
}

void Console::save() {
  saved_.push_back({run_->robot, run_->controller, hands().history(), run_->recording});
  say(fmt::format("kept: state {} at {:.2f} s; b returns to it", saved_.size(), saved_.back().repeated.time_s));
}

void Console::restore(std::size_t which) {
  pace_.setPaused(true);
  wanted_run = saved_.at(which);
  say(fmt::format("back to state {} at {:.2f} s; p goes on", which + 1, wanted_run->repeated.time_s));
}

void Console::restoreLast() {
  if (saved_.empty()) return say("no state is kept yet: k keeps one");
  restore(saved_.size() - 1);
}

void Console::raiseTarget(float by_mm) {
  if (!target_mm) return say("this controller has no target");
  const std::optional<Vector> moved_mm = hands().movedTargetMm();
  moveTarget((moved_mm ? moved_mm->cast<float>() : *target_mm) + Eigen::Vector3f(0, by_mm, 0));
}

void Console::moveTarget(const Eigen::Vector3f& to_mm) {
  hands().moveTarget(to_mm.cast<double>());
  say(fmt::format("target {:.0f}, {:.0f}, {:.0f} mm", to_mm.x(), to_mm.y(), to_mm.z()));
}

void Console::resetView() {
  camera = first_camera_;
  keeps_in_view = false;
}

void Console::zoom(float factor) {
  camera.zoom(factor);
  keeps_in_view = false;
}

void Console::rotate(float right_px, float down_px) {
  camera.rotate(right_px, down_px);
  keeps_in_view = false;
}

void Console::pan(float right_px, float down_px, float height_px) {
  camera.pan(right_px, down_px, height_px);
  keeps_in_view = false;
}

/// A little per picture, so that the view glides.
void Console::keepInView(const Bounds& bounds, float width_px, float height_px) {
  constexpr float glide = 1.03F;
  if (keeps_in_view && !camera.shows(bounds.low, bounds.high, width_px, height_px)) camera.zoom(1 / glide);
}

void Console::play(double wall_s) {
  if (pace_.isPaused()) return;
  if (!player_->advance(wall_s * pace_.speed())) pace_.setPaused(true);
}

/// At the end of a replay that does not loop, resuming begins again.
void Console::togglePause() {
  const bool pause = !pace_.isPaused();
  if (player_ && !pause && player_->timeS() >= player_->endS()) player_->seek(player_->beginS());
  pace_.setPaused(pause);
}

void Console::toggleEffects() {
  if (!player_->hasEffects()) return say("no effects were given: --effects FILE");
  player_->setEffects(!player_->withEffects());
  say(player_->withEffects() ? "with the effects" : "without the effects");
}

void Console::toggleGhost() {
  if (!player_->hasGhost()) return say("no measured pose: " + player_->ghostSource());
  flip(*this, style.ghost, "measured pose");
}

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
  const double pressure = hands().pressures()[static_cast<std::size_t>(selected())] + by_ratio;
  setPressure(selected(), std::round(pressure * hundred) / hundred);
}

void Console::setPressure(int muscle, double pressure_ratio) {
  if (!hands().isManual()) say("muscles under manual control; press i for automatic");
  hands().set(muscle, pressure_ratio);
}

void Console::toggleManual() {
  hands().isManual() ? hands().handBack() : hands().takeOver();
  say(hands().isManual() ? "by hand" : "automatic");
}

void Console::say(const std::string& message) {
  constexpr std::chrono::milliseconds at_least(3000), per_letter(50);
  notice_ = message;
  notice_until_ = std::chrono::steady_clock::now() + at_least + per_letter * static_cast<int>(message.size());
}

std::string Console::notice() const {
  if (std::chrono::steady_clock::now() < notice_until_) return notice_;
  if (run_ && hands().isRepeating()) return fmt::format("repeats the run up to {:.2f} s", hands().repeatedUntilS());
  return "";
}

nlohmann::json Console::state() const {
  nlohmann::json state = {{"selected", style.selected},
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
                          {"arrows", style.arrows},
                          {"help", show_help},
                          {"panel", show_panel},
                          {"hidden_plots", hidden_plots},
                          {"video", wants_video}};
  if (divergence) state["divergence"] = *divergence;
  if (run_) {
    state["manual"] = hands().isManual();
    state["pressures"] = hands().pressures();
    state["robot"] = run_->robot;
    state["controller"] = run_->controller;
    state["saved"] = saved_.size();
    state["repeating"] = hands().isRepeating();
    if (target_mm) state["target_mm"] = {target_mm->x(), target_mm->y(), target_mm->z()};
  }
  if (player_) state["replay"] = replayState();
  return state;
}

nlohmann::json Console::replayState() const {
  const ReplayGap* gap = player_->gap();
  nlohmann::json state = {{"row", player_->row()},
                          {"with_effects", player_->withEffects()},
                          {"ghost", player_->hasGhost() && style.ghost},
                          {"looping", player_->isLooping()},
                          {"signal", gap ? nlohmann::json(gap->name) : nullptr},
                          {"rmse", gap ? nlohmann::json(gap->rmse()) : nullptr},
                          {"outside_s", player_->outsideS()}};
  const std::optional<double> distance = distanceOfGhostMm(*player_->snapshot());
  state["ghost_distance_mm"] = distance ? nlohmann::json(*distance) : nullptr;
  return state;
}

}  // namespace musclesim
