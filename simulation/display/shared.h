/// What the run's thread and the window's thread share.
#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "display_options.h"
#include "pace.h"
#include "player.h"
#include "run_request.h"
#include "simulation/snapshot.h"

namespace musclesim {

struct DisplayShared {
  DisplayShared(DisplayOptions given, std::shared_ptr<const ShownRun> run, std::unique_ptr<Player> played, Snapshot first)
      : options(std::move(given)),
        player(std::move(played)),
        pace(options.speed_ratio),
        latest_{std::move(run), std::make_shared<const Snapshot>(std::move(first))} {}

  /// A run (null for a replay) and its latest state.
  struct Shown {
    std::shared_ptr<const ShownRun> run;
    std::shared_ptr<const Snapshot> snapshot;
  };

  const DisplayOptions options;
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
    latest_.snapshot = std::move(next);
  }
  /// Another run takes the place of the present one.
  void begin(std::shared_ptr<const ShownRun> run, Snapshot first) {
    pace.restart();
    const std::lock_guard lock(access_);
    latest_ = {std::move(run), std::make_shared<const Snapshot>(std::move(first))};
    divergence_.reset();
  }
  Shown current() {
    const std::lock_guard lock(access_);
    return latest_;
  }
  /// The user wants another run.
  void ask(RunRequest request) {
    const std::lock_guard lock(access_);
    request_ = std::move(request);
  }
  bool isAsked() {
    const std::lock_guard lock(access_);
    return request_.has_value();
  }
  std::optional<RunRequest> takeRequest() {
    const std::lock_guard lock(access_);
    return std::exchange(request_, std::nullopt);
  }
  /// A message of the run's thread to the user.
  void say(const std::string& message) {
    const std::lock_guard lock(access_);
    message_ = message;
  }
  std::optional<std::string> takeMessage() {
    const std::lock_guard lock(access_);
    return std::exchange(message_, std::nullopt);
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
  Shown latest_;
  std::optional<RunRequest> request_;
  std::optional<std::string> divergence_, loss_, message_;
};

}  // namespace musclesim
