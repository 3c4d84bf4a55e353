/// The speed of a run in a window: wall clock, pause and single steps.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <utility>

namespace musclesim {

/// Makes a run wait between its steps; it does not change the steps. The run's thread calls waitFor, the viewer's thread everything else.
/// If a run cannot keep up, it does not catch up later: the lost time is forgotten.
class Pace {
 public:
  /// `speed_ratio`: simulated time over wall time.
  explicit Pace(double speed_ratio) : speed_ratio_(speed_ratio) {}

  /// Waits until a simulated time is due. Returns false if the viewer has closed or `interrupted` (called now and then) returns true.
  bool waitFor(double simulated_s, const std::function<bool()>& interrupted);

  void setSpeed(double speed_ratio);  ///< clamped to 0.001 .. 10000
  double speed() const;
  void setPaused(bool paused);
  bool isPaused() const;
  void restart();   ///< counts from the next simulated time, whatever it is
  void stepOnce();  ///< pauses after one more step
  void close();
  bool isClosed() const;
  /// Simulated time over wall time, measured over the last second; 0 while paused.
  double measuredSpeed() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Instant = std::pair<Clock::time_point, double>;  ///< wall time and simulated time, s
  Clock::time_point dueAt(double simulated_s) const;
  void arrive(double simulated_s);

  mutable std::mutex access_;
  std::condition_variable changed_;
  double speed_ratio_;
  bool paused_ = false, closed_ = false, restart_ = true;
  int steps_allowed_ = 0;
  Instant reference_;
  std::deque<Instant> recent_;
};

}  // namespace musclesim
