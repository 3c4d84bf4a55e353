#include "pace.h"

#include <algorithm>

namespace musclesim {

namespace {

using namespace std::chrono_literals;
constexpr auto look_around = 50ms, forgotten_lag = 100ms, measured_over = 1000ms;

std::chrono::steady_clock::duration seconds(double s) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(s));
}

}  // namespace

Pace::Clock::time_point Pace::dueAt(double simulated_s) const {
  return reference_.first + seconds((simulated_s - reference_.second) / speed_ratio_);
}

bool Pace::waitFor(double simulated_s, const std::function<bool()>& interrupted) {
  std::unique_lock lock(access_);
  while (!closed_ && !interrupted()) {
    if (paused_) {
      restart_ = true;
      if (steps_allowed_ > 0) {
        --steps_allowed_;
        return true;
      }
      changed_.wait_for(lock, look_around);
      continue;
    }
    if (restart_) {
      reference_ = {Clock::now(), simulated_s};
      recent_.clear();
      restart_ = false;
    }
    const auto now = Clock::now(), due = dueAt(simulated_s);
    if (now >= due) {
      arrive(simulated_s);
      return true;
    }
    changed_.wait_until(lock, std::min(due, now + look_around));
  }
  return false;
}

void Pace::arrive(double simulated_s) {
  const auto now = Clock::now();
  if (now - dueAt(simulated_s) > forgotten_lag) reference_ = {now, simulated_s};
  recent_.emplace_back(now, simulated_s);
  while (recent_.size() > 2 && now - recent_.front().first > measured_over) recent_.pop_front();
}

void Pace::restart() {
  const std::lock_guard lock(access_);
  restart_ = true;
}

void Pace::setSpeed(double speed_ratio) {
  const std::lock_guard lock(access_);
  speed_ratio_ = std::clamp(speed_ratio, 1e-3, 1e4);
  restart_ = true;
  changed_.notify_all();
}

double Pace::speed() const {
  const std::lock_guard lock(access_);
  return speed_ratio_;
}

void Pace::setPaused(bool paused) {
  const std::lock_guard lock(access_);
  paused_ = paused;
  steps_allowed_ = 0;
  changed_.notify_all();
}

bool Pace::isPaused() const {
  const std::lock_guard lock(access_);
  return paused_;
}

void Pace::stepOnce() {
  const std::lock_guard lock(access_);
  paused_ = true;
  ++steps_allowed_;
  changed_.notify_all();
}

void Pace::close() {
  const std::lock_guard lock(access_);
  closed_ = true;
  changed_.notify_all();
}

bool Pace::isClosed() const {
  const std::lock_guard lock(access_);
  return closed_;
}

double Pace::measuredSpeed() const {
  const std::lock_guard lock(access_);
  if (paused_ || recent_.size() < 2) return 0;
  const std::chrono::duration<double> wall = recent_.back().first - recent_.front().first;
  return wall.count() > 0 ? (recent_.back().second - recent_.front().second) / wall.count() : 0;
}

}  // namespace musclesim
