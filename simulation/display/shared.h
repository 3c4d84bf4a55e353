/// What the run's thread and the window's thread share.
#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "display_options.h"
#include "musclesim/controller/manual.h"
#include "pace.h"
#include "player.h"
#include "simulation/snapshot.h"

namespace musclesim {

struct DisplayShared {
  DisplayShared(DisplayOptions given, ManualController* controller, std::unique_ptr<Player> played, Snapshot first)
      : options(std::move(given)),
        hands(controller),
        player(std::move(played)),
        pace(options.speed_ratio),
        latest_(std::make_shared<const Snapshot>(std::move(first))) {}

  const DisplayOptions options;
  ManualController* const hands;         ///< of a run; null for a replay
  const std::unique_ptr<Player> player;  ///< of a replay, for the window's thread alone; null for a run
  Pace pace;
  std::promise<void> opened;            ///< set when the window is open, or to the exception why it could not open
  std::atomic<bool> is_ending = false;  ///< the window draws nothing any more
  std::atomic<bool> has_ended = false;  ///< the window's thread has ended
  std::atomic<bool> is_stuck = false;   ///< the window's thread can never end, since its display or window is gone
  std::atomic<long> frame_count = 0;
  std::chrono::steady_clock::time_point opened_at;

  void publish(Snapshot snapshot) {
    auto next = std::make_shared<const Snapshot>(std::move(snapshot));
    const std::lock_guard lock(access_);
    latest_ = std::move(next);
  }
  std::shared_ptr<const Snapshot> current() {
    const std::lock_guard lock(access_);
    return latest_;
  }
  /// Called if the window cannot continue. Errors after its end are ignored.
  void lose(const std::string& reason) {
    if (!pace.isClosed()) {
      const std::lock_guard lock(access_);
      if (!loss_) loss_ = reason;
    }
    pace.close();
  }
  std::optional<std::string> loss() {
    const std::lock_guard lock(access_);
    return loss_;
  }
  void setDivergence(const std::string& message) {
    const std::lock_guard lock(access_);
    divergence_ = message;
  }
  std::optional<std::string> currentDivergence() {
    const std::lock_guard lock(access_);
    return divergence_;
  }

 private:
  std::mutex access_;
  std::shared_ptr<const Snapshot> latest_;
  std::optional<std::string> divergence_, loss_;
};

}  // namespace musclesim
