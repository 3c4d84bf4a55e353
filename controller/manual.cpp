#include "musclesim/controller/manual.h"

#include <algorithm>
#include <string>

#include "musclesim/base/error.h"

namespace musclesim {

ManualController::ManualController(std::unique_ptr<Controller> automatic, int muscle_count) : automatic_(std::move(automatic)) {
  if (!automatic_) throw BadParameter("manual control: needs a controller to take over from");
  if (muscle_count < 1) throw BadParameter("muscles of manual control", std::to_string(muscle_count), "be at least 1");
  pressures_.assign(static_cast<std::size_t>(muscle_count), 0.0);
}

Action ManualController::output(const State& state) {
  const std::lock_guard lock(access_);
  if (!manual_) pressures_ = automatic_->output(state);
  note(state);
  return pressures_;
}

void ManualController::note(const State& state) {
  if (manual_ && !was_manual_) intervals_.push_back({state.time_s, state.time_s});
  if (was_manual_) intervals_.back().to_s = state.time_s;
  was_manual_ = manual_;
}

void ManualController::takeOver() {
  const std::lock_guard lock(access_);
  manual_ = true;
}

void ManualController::handBack() {
  const std::lock_guard lock(access_);
  manual_ = false;
}

bool ManualController::isManual() const {
  const std::lock_guard lock(access_);
  return manual_;
}

void ManualController::set(int muscle, double pressure_ratio) {
  const std::lock_guard lock(access_);
  if (muscle < 0 || muscle >= static_cast<int>(pressures_.size()))
    throw BadParameter("muscle", std::to_string(muscle), "lie in 0 .. " + std::to_string(pressures_.size() - 1));
  manual_ = true;
  pressures_[static_cast<std::size_t>(muscle)] = std::clamp(pressure_ratio, 0.0, 1.0);
}

void ManualController::reset() {
  const std::lock_guard lock(access_);
  manual_ = true;
  std::fill(pressures_.begin(), pressures_.end(), 0.0);
}

Action ManualController::pressures() const {
  const std::lock_guard lock(access_);
  return pressures_;
}

std::vector<ManualController::Interval> ManualController::manualIntervals() const {
  const std::lock_guard lock(access_);
  return intervals_;
}

}  // namespace musclesim
