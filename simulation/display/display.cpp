#include "display.h"

#include <chrono>

#include "musclesim/base/error.h"
#include "shared.h"
#include "window.h"

namespace musclesim {

namespace {

/// Runs the window and records a failure before the window is destroyed, since destroying it closes the pace.
void loop(Window& window, DisplayShared& shared) {
  try {
    window.loop();
  } catch (const std::exception& error) {
    shared.lose(error.what());
  } catch (...) {
    shared.lose("unknown failure");
  }
}

void runWindow(DisplayShared& shared) {
  bool is_open = false;
  try {
    Window window(shared);
    shared.opened_at = std::chrono::steady_clock::now();
    is_open = true;
    shared.opened.set_value();
    loop(window, shared);
  } catch (...) {
    if (!is_open) shared.opened.set_exception(std::current_exception());
  }
  shared.pace.close();
  shared.has_ended = true;
}

/// Detaches a thread that cannot end and leaves it the data that it uses.
void abandon(std::jthread& thread, std::unique_ptr<DisplayShared>& shared) {
  thread.detach();
  static_cast<void>(shared.release());
}

constexpr auto poll_interval = std::chrono::milliseconds(5);

}  // namespace

Display::Display(DisplayOptions options, ShownRun run, Snapshot first)
    : shared_(std::make_unique<DisplayShared>(std::move(options), std::make_shared<const ShownRun>(std::move(run)), nullptr,
                                              std::move(first))) {
  open();
}

Display::Display(DisplayOptions options, std::unique_ptr<Player> player) {
  Snapshot first = *player->snapshot();
  shared_ = std::make_unique<DisplayShared>(std::move(options), nullptr, std::move(player), std::move(first));
  open();
}

void Display::open() {
  thread_ = std::jthread([shared = shared_.get()] { runWindow(*shared); });
  auto opened = shared_->opened.get_future();
  while (opened.wait_for(poll_interval) != std::future_status::ready) {
    if (!shared_->is_stuck) continue;
    const std::string reason = shared_->loss().value_or("the display is gone");
    abandon(thread_, shared_);
    throw IoError("no window can be opened: " + reason);
  }
  opened.get();
}

Display::~Display() {
  shared_->pace.close();
  while (!shared_->has_ended && !shared_->is_stuck) std::this_thread::sleep_for(poll_interval);
  if (shared_->is_stuck) abandon(thread_, shared_);
}

bool Display::show(Snapshot snapshot, const Interrupted& interrupted) {
  const double time_s = snapshot.state.time_s;
  shared_->publish(std::move(snapshot));
  return shared_->pace.waitFor(time_s, [&] { return interrupted() || shared_->isAsked(); });
}

bool Display::showAtOnce(Snapshot snapshot, const Interrupted& interrupted) {
  shared_->publish(std::move(snapshot));
  return !shared_->pace.isClosed() && !shared_->isAsked() && !interrupted();
}

void Display::begin(ShownRun run, Snapshot first) {
  shared_->begin(std::make_shared<const ShownRun>(std::move(run)), std::move(first));
}

std::optional<RunRequest> Display::takeRequest() {
  return shared_->takeRequest();
}

bool Display::isAsked() const {
  return shared_->isAsked();
}

void Display::say(const std::string& message) {
  shared_->say(message);
}

void Display::showDivergence(const std::string& message, const Interrupted& interrupted) {
  shared_->setDivergence(message);
  shared_->pace.setPaused(true);
  waitForEnd(interrupted);
}

void Display::waitForEnd(const Interrupted& interrupted) {
  while (!shared_->pace.isClosed() && !shared_->isAsked() && !interrupted()) std::this_thread::sleep_for(poll_interval);
}

std::optional<std::string> Display::loss() const {
  return shared_->loss();
}

double Display::framesPerS() const {
  const std::chrono::duration<double> open = std::chrono::steady_clock::now() - shared_->opened_at;
  return static_cast<double>(shared_->frame_count) / open.count();
}

}  // namespace musclesim
