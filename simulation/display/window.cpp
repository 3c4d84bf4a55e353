#include "window.h"

#include <GL/freeglut.h>
#include <X11/Xlib.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "musclesim/base/error.h"
#include "painter.h"
#include "simulation/scene/scene_error.h"

namespace musclesim {

namespace {

using namespace std::chrono_literals;

constexpr auto shortest_frame = std::chrono::microseconds(16666), longest_frame = std::chrono::microseconds(28000);
constexpr double video_frames_per_s = 30;
constexpr int wheel_up = 3, wheel_down = 4, drag_threshold_px = 3;
constexpr float wheel_zoom = 1.1F;

/// A global variable, because Xlib's handlers get no user pointer.
DisplayShared* shared_of_handlers = nullptr;

/// Stops the window's thread for good if it cannot continue; the run's thread then writes the files.
[[noreturn]] void stopHere(const std::string& reason) {
  shared_of_handlers->lose(reason);
  shared_of_handlers->is_stuck = true;
  for (;;) pause();
}

/// Handles a lost display. Without this handler Xlib would end the process.
int stopAtLostDisplay(::Display*) {
  stopHere("the connection to the display is lost");
}

/// Handles X errors, mostly because the window is gone. To continue would be unsafe: Mesa's software rendering would use a window size that
/// the failed query left unset. An error is harmless only if nothing is drawn any more.
int stopAtError(::Display* display, XErrorEvent* error) {
  if (shared_of_handlers->is_ending) return 0;
  char text[256];
  XGetErrorText(display, error->error_code, text, sizeof text);
  stopHere(fmt::format("X error in request {}.{}: {}", error->request_code, error->minor_code, text));
}

/// Checks that there is a display, since GLUT does not. It keeps its connection while GLUT makes its own, because a server may restart when
/// its last connection closes.
class DisplayProbe {
 public:
  DisplayProbe() : display_(XOpenDisplay(nullptr)) {
    if (!display_)
      throw SceneError("there is no display for a window: use --simple to run without one, --screenshot or --video for pictures");
  }
  ~DisplayProbe() { XCloseDisplay(display_); }
  DisplayProbe(const DisplayProbe&) = delete;
  DisplayProbe& operator=(const DisplayProbe&) = delete;

 private:
  ::Display* display_;
};

[[noreturn]] void throwGlutError(const char* format, va_list arguments, void*) {
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  throw SceneError(std::string("no window can be opened: ") + text + "; use --simple, or --screenshot and --video for pictures");
}

int codeOf(int glut_key) {
  switch (glut_key) {
    case GLUT_KEY_F1:
      return key::f1;
    case GLUT_KEY_UP:
      return key::up;
    case GLUT_KEY_DOWN:
      return key::down;
    case GLUT_KEY_LEFT:
      return key::left;
    case GLUT_KEY_RIGHT:
      return key::right;
    case GLUT_KEY_HOME:
      return key::home;
    case GLUT_KEY_END:
      return key::end;
    case GLUT_KEY_PAGE_UP:
      return key::page_up;
    case GLUT_KEY_PAGE_DOWN:
      return key::page_down;
    default:
      return -1;
  }
}

std::string nameOfKey(int code) {
  for (const auto& [named, name] : {std::pair{key::escape, "Esc"},
                                    {key::f1, "F1"},
                                    {key::up, "Up"},
                                    {key::down, "Down"},
                                    {key::left, "Left"},
                                    {key::right, "Right"},
                                    {key::home, "Home"},
                                    {key::end, "End"},
                                    {key::page_up, "PgUp"},
                                    {key::page_down, "PgDn"},
                                    {key::tab, "Tab"},
                                    {static_cast<int>(' '), "Space"}})
    if (named == code) return name;
  return std::string(1, static_cast<char>(code));
}

}  // namespace

Window::Window(DisplayShared& shared)
    : shared_(shared),
      seen_(shared.current().snapshot),
      console_(shared.player ? Console(*shared.player, shared.pace, shared.options.camera) : Console(shared.current().run, shared.pace)),
      width_(shared.options.width_px),
      height_(shared.options.height_px) {
  if (!shared.options.log_file.empty()) {
    log_.open(shared.options.log_file);
    if (!log_) throw IoError(shared.options.log_file + ": cannot be written");
  }
  shared_of_handlers = &shared_;
  open();
  gl_ = Gl::load([](const char* name) { return reinterpret_cast<void*>(glutGetProcAddress(name)); });
  scene_ = std::make_unique<Scene>(gl_);
  panel_ = Panel::make();
  if (panel_) panel_->resize(width_, height_);
  console_.show_panel = panel_ != nullptr;
  console_.style.arrows = shared_.options.arrows;
  console_.robots = shared_.options.robots;
  console_.controllers = shared_.options.controllers;
  listen();
}

Window::~Window() {
  if (window_ != 0) {
    closed();
    glutDestroyWindow(window_);
  }
  glutExit();
}

void Window::open() {
  const DisplayProbe probe;
  glutInitErrorFuncUcall(throwGlutError, nullptr);
  int count = 1;
  char name[] = "musclesim";
  char* arguments[] = {name, nullptr};
  XSetIOErrorHandler(stopAtLostDisplay);
  XSetErrorHandler(stopAtError);
  glutInit(&count, arguments);
  glutSetOption(GLUT_ACTION_ON_WINDOW_CLOSE, GLUT_ACTION_CONTINUE_EXECUTION);
  glutInitDisplayMode(GLUT_RGB | GLUT_DOUBLE | GLUT_DEPTH);
  glutInitWindowSize(width_, height_);
  window_ = glutCreateWindow(shared_.options.title.c_str());
}

void Window::listen() {
  glutDisplayFuncUcall([](void*) {}, nullptr);  // drawn by loop()
  glutCloseFuncUcall([](void* w) { static_cast<Window*>(w)->closed(); }, this);
  glutReshapeFuncUcall(
      [](int width, int height, void* w) {
        auto* window = static_cast<Window*>(w);
        window->width_ = std::max(1, width);
        window->height_ = std::max(1, height);
        if (window->panel_) window->panel_->resize(width, height);
      },
      this);
  glutKeyboardFuncUcall([](unsigned char c, int, int, void* w) { static_cast<Window*>(w)->press(c); }, this);
  glutSpecialFuncUcall([](int k, int, int, void* w) { static_cast<Window*>(w)->press(codeOf(k)); }, this);
  glutKeyboardUpFuncUcall(
      [](unsigned char c, int, int, void* w) {
        if (auto& panel = static_cast<Window*>(w)->panel_) panel->keyUp(c);
      },
      this);
  glutMouseFuncUcall([](int which, int state, int x, int y, void* w) { static_cast<Window*>(w)->button(which, state, x, y); }, this);
  glutMotionFuncUcall([](int x, int y, void* w) { static_cast<Window*>(w)->drag(x, y); }, this);
  glutPassiveMotionFuncUcall(
      [](int x, int y, void* w) {
        if (auto& panel = static_cast<Window*>(w)->panel_) panel->move(x, y);
      },
      this);
}

/// Frees everything; called while the context still exists and is current.
void Window::closed() {
  shared_.is_ending = true;
  shared_.pace.close();
  window_ = 0;
  panel_.reset();
  target_.reset();
  scene_.reset();
  video_.reset();
}

void Window::loop() {
  auto next_frame = Clock::now();
  while (!shared_.pace.isClosed()) {
    glutMainLoopEvent();
    if (window_ == 0) return;
    if (shared_.pace.isClosed()) break;
    const auto now = Clock::now();
    if (now < next_frame) {
      std::this_thread::sleep_for(std::min<Clock::duration>(next_frame - now, 2ms));
      continue;
    }
    draw();
    if (shared_.frame_count == 1) log("open");
    // Leave at least half of the time to the simulation and to events.
    const auto cost = Clock::now() - now;
    watchCost(cost);
    next_frame = now + std::clamp<Clock::duration>(2 * cost, shortest_frame, longest_frame);
  }
  log("close");
}

void Window::fitTarget() {
  const int scene_width = std::max(1, width_ - (panel_ && console_.show_panel ? panel_->widthPx() : 0));
  if (target_ && target_->width() == scene_width && target_->height() == height_ && target_->isSmooth() == is_smooth_) return;
  target_ = std::make_unique<GpuTarget>(gl_, scene_width, height_, is_smooth_ ? GpuTarget::smooth : GpuTarget::plain);
}

/// The frame rate matters more than smooth edges: if drawing is too slow, there is one sample per pixel from then on.
void Window::watchCost(Clock::duration cost) {
  constexpr auto affordable = 25ms;
  constexpr int weight = 8, warm_up_frames = 12;
  mean_cost_ += (cost - mean_cost_) / weight;
  if (is_smooth_ && shared_.frame_count > warm_up_frames && mean_cost_ > affordable) is_smooth_ = false;
}

/// Takes what the run's thread has published, and passes on what the user wants of it.
void Window::follow() {
  const auto [run, snapshot] = shared_.current();
  seen_ = snapshot;
  if (run.get() != &console_.run()) {
    grab_.reset();
    history_ = {};
    console_.attach(run);
    glutSetWindowTitle(run->title.c_str());
  }
  console_.divergence = shared_.currentDivergence();
  if (const auto message = shared_.takeMessage()) console_.say(*message);
  if (const auto wanted = std::exchange(console_.wanted_run, std::nullopt)) shared_.ask(*wanted);
  history_.add(*seen_);
  showMovedTarget();
}

/// The run takes a moved target over with its next step, the picture at once.
void Window::showMovedTarget() {
  const auto moved_mm = console_.hands().movedTargetMm();
  if (seen_->target && moved_mm) {
    Snapshot changed = *seen_;
    changed.target->point_mm = changed.target->movedTo(moved_mm->cast<float>());
    seen_ = std::make_shared<const Snapshot>(std::move(changed));
  }
  console_.target_mm.reset();
  if (seen_->target) console_.target_mm = seen_->target->point_mm;
}

/// Moves a replay on by the time since the last picture.
void Window::play() {
  const auto now = Clock::now();
  const double wall_s = std::chrono::duration<double>(now - std::exchange(played_at_, now)).count();
  if (!is_scrubbing_) console_.play(wall_s);
  console_.divergence = shared_.player->divergence();
  seen_ = shared_.player->snapshot();
}

void Window::draw() {
  if (shared_.player)
    play();
  else
    follow();
  fitTarget();
  console_.keepInView(boundsOf(current()), static_cast<float>(target_->width()), static_cast<float>(height_));
  scene_->draw(current(), console_.camera, console_.style, *target_);
  savePictures();
  drawOver(current());
  glutSwapBuffers();
  ++shared_.frame_count;
}

void Window::drawOver(const Snapshot& snapshot) {
  if (panel_) return panel_->draw(console_, snapshot, history_, width_, height_);
  BitmapPainter painter(width_, height_);
  drawOverlay(painter, console_, snapshot, static_cast<float>(width_), static_cast<float>(height_), true);
}

void Window::press(int code) {
  if (panel_ && code < 128 && panel_->key(static_cast<unsigned char>(code))) return;
  if (code == key::tab && !panel_) return console_.say("this build has no panel");
  if (console_.press(code)) log(nameOfKey(code));
}

TimeLine Window::timeLine() const {
  return TimeLine::in(static_cast<float>(target_->width()), static_cast<float>(height_));
}

void Window::scrubTo(int x) {
  shared_.player->seek(timeLine().timeAt(*shared_.player, static_cast<float>(x)));
}

/// Follows the pointer from a press on the time line to its release. Returns true if the time line uses the event.
bool Window::scrub(int which, int state, int x, int y) {
  if (!shared_.player || which != GLUT_LEFT_BUTTON) return false;
  const bool begins = state == GLUT_DOWN && timeLine().contains(static_cast<float>(x), static_cast<float>(y));
  const bool ends = state == GLUT_UP && is_scrubbing_;
  if (!begins && !ends) return false;
  is_scrubbing_ = begins;
  scrubTo(x);
  if (ends) log("scrub");
  return true;
}

void Window::button(int which, int state, int x, int y) {
  if (panel_ && panel_->button(which, state, x, y)) return;
  if (scrub(which, state, x, y)) return;
  if (which == wheel_up || which == wheel_down) {
    if (state == GLUT_DOWN) console_.zoom(which == wheel_up ? wheel_zoom : 1 / wheel_zoom);
    return log("wheel");
  }
  if (state == GLUT_DOWN) {
    dragged_button_ = which;
    last_x_ = x;
    last_y_ = y;
    has_moved_ = false;
    if (which == GLUT_LEFT_BUTTON && (glutGetModifiers() & GLUT_ACTIVE_CTRL) != 0) grab(x, y);
    return;
  }
  if (dragged_button_ != which) return;
  dragged_button_ = -1;
  if (grab_) return letGo();
  if (!has_moved_ && which == GLUT_LEFT_BUTTON) pickMuscle(x, y);
  log(has_moved_ ? "drag" : "click");
}

void Window::drag(int x, int y) {
  if (panel_) panel_->move(x, y);
  if (is_scrubbing_) return scrubTo(x);
  const int right = x - last_x_, down = y - last_y_;
  if (dragged_button_ < 0 || (!has_moved_ && std::abs(right) + std::abs(down) < drag_threshold_px)) return;
  has_moved_ = true;
  last_x_ = x;
  last_y_ = y;
  if (grab_) return dragGrabbed(x, y);
  const auto dx = static_cast<float>(right), dy = static_cast<float>(down);
  if (dragged_button_ == GLUT_LEFT_BUTTON)
    console_.rotate(dx, dy);
  else
    console_.pan(dx, dy, static_cast<float>(height_));
}

/// Selects the muscle whose line passes nearest to the pointer, if one is near.
void Window::pickMuscle(int x, int y) {
  constexpr float near_px = 12;
  const Eigen::Vector2f pointer(static_cast<float>(x), static_cast<float>(y));
  const Snapshot& snapshot = current();
  float nearest = near_px;
  for (std::size_t i = 0; i < snapshot.hoses.size(); ++i) {
    for (const Eigen::Vector3f& point : smoothCurve(snapshot.hoses[i].points_mm)) {
      const auto seen = console_.camera.pixelOf(point, static_cast<float>(target_->width()), static_cast<float>(height_));
      if (!seen || (*seen - pointer).norm() >= nearest) continue;
      nearest = (*seen - pointer).norm();
      console_.select(static_cast<int>(i));
    }
  }
}

/// Takes hold of the bone or the target under the pointer.
void Window::grab(int x, int y) {
  if (shared_.player) return console_.say("a replay cannot be pulled at: it has been simulated");
  const Camera& camera = console_.camera;
  const Eigen::Vector3f through = camera.pointUnder(Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)), camera.center_mm,
                                                    static_cast<float>(target_->width()), static_cast<float>(height_));
  grab_ = grabAt(current(), camera.eyeMm(), through);
  if (!grab_) return console_.say("there is no bone under the pointer");
  if (grab_->primitive >= 0 && console_.pace().isPaused()) console_.say("the run is paused: it is pulled as soon as it goes on");
}

/// Moves the hand in the plane through the place where it took hold, parallel to the picture.
void Window::dragGrabbed(int x, int y) {
  const Eigen::Vector3f to_mm = console_.camera.pointUnder(Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)), grab_->seen_mm,
                                                           static_cast<float>(target_->width()), static_cast<float>(height_));
  if (grab_->primitive < 0) {
    if (current().target) console_.moveTarget(current().target->movedTo(to_mm));
    return;
  }
  console_.hands().pull(Pull{static_cast<std::size_t>(grab_->primitive), grab_->point_mm.cast<double>(), to_mm.cast<double>()});
}

void Window::letGo() {
  if (grab_->primitive >= 0) console_.hands().pull(std::nullopt);
  log(grab_->primitive < 0 ? "target" : "pull");
  grab_.reset();
}

std::string Window::fileFor(const char* extension) const {
  for (int number = 1;; ++number) {
    const std::string file = fmt::format("{}/window-{}{}", shared_.options.picture_folder, number, extension);
    if (!std::filesystem::exists(file)) return file;
  }
}

/// Saves the scene without the overlay.
void Window::savePictures() {
  try {
    if (console_.wants_screenshot) saveScreenshot();
    updateVideo();
  } catch (const Error& error) {
    console_.say(error.what());
    console_.wants_video = false;
    video_.reset();
  }
  console_.wants_screenshot = false;
}

/// A screenshot always has smooth edges.
void Window::saveScreenshot() {
  const std::string file = fileFor(".png");
  const GpuTarget target(gl_, target_->width(), target_->height(), GpuTarget::smooth);
  scene_->draw(current(), console_.camera, console_.style, target);
  writePng(target.read(), file);
  console_.say("picture " + file);
}

/// A video shows the scene of the window in wall time; late frames are replaced by repeating the last one.
void Window::updateVideo() {
  if (console_.wants_video && !video_) {
    video_ = std::make_unique<VideoWriter>(fileFor(".mp4"), target_->width(), target_->height(), video_frames_per_s);
    video_start_ = Clock::now();
    console_.say("video started; press v to stop");
  }
  if (!video_) return;
  if (!console_.wants_video) {
    video_->close();
    console_.say("video " + video_->result());
    video_.reset();
    return;
  }
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - video_start_).count();
  if (elapsed_s * video_frames_per_s < static_cast<double>(video_->frameCount())) return;
  const Image frame = target_->read();
  while (elapsed_s * video_frames_per_s >= static_cast<double>(video_->frameCount())) video_->add(frame);
}

void Window::log(const std::string& event) {
  if (!log_.is_open()) return;
  nlohmann::json line = console_.state();
  line["event"] = event;
  line["smooth"] = is_smooth_;
  const auto latest = shared_.player ? shared_.player->snapshot() : shared_.current().snapshot;
  line["pull_N"] = latest->pull ? nlohmann::json(latest->pull->force_N) : nullptr;
  line["time_s"] = latest->state.time_s;
  line["frames_per_s"] = static_cast<double>(shared_.frame_count) / std::chrono::duration<double>(Clock::now() - shared_.opened_at).count();
  log_ << line.dump() << std::endl;
}

}  // namespace musclesim
