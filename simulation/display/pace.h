/// How fast a run goes on: the viewer's clock, pause and single steps.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <utility>

namespace musclesim {

/// Lets a run wait between its steps; only waits, so the steps themselves stay what they are. Used by the run's thread (waitFor) and by the
/// viewer's (all others). A run that cannot keep up is not hurried: the time it lost is forgotten.
class Pace {
 public:
  /// `speed_ratio`: simulated time over wall time.
  explicit Pace(double speed_ratio) : speed_ratio_(speed_ratio) {}

  /// Waits until it is the moment of a simulated time. False: the viewer has closed, or `interrupted` (asked now and then) says so.
  bool waitFor(double simulated_s, const std::function<bool()>& interrupted);

  void setSpeed(double speed_ratio);  ///< clamped to 0.001 .. 10000
  double speed() const;
  void setPaused(bool paused);
  bool isPaused() const;
  void stepOnce();  ///< pauses after one more step
  void close();
  bool isClosed() const;
  /// Simulated time over wall time, measured over the last second; 0 while paused.
  double measuredSpeed() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Moment = std::pair<Clock::time_point, double>;  ///< wall time and simulated time, s
  Clock::time_point dueAt(double simulated_s) const;
  void arrive(double simulated_s);

  mutable std::mutex access_;
  std::condition_variable changed_;
  double speed_ratio_;
  bool paused_ = false, closed_ = false, restart_ = true;
  int steps_allowed_ = 0;
  Moment reference_;
  std::deque<Moment> recent_;
};

}  // namespace musclesim
