/// The clock of a simulation.
#pragma once

namespace musclesim {

/// Counts steps; no time is ever summed up.
///     t = t_0 + n T           at control steps:   n control steps of T since t_0
///     t = t_0 + n T + i h     within one:         and i internal steps of h
/// All in s.
class Clock {
 public:
  explicit Clock(double step_s = 0.01) : step_s_(step_s) {}

  /// t_0 + n T
  double time_s() const { return start_s_ + static_cast<double>(step_count_) * step_s_; }
  /// t_0 + n T + i h
  double now_s() const { return time_s() + static_cast<double>(internal_count_) * internal_step_s_; }
  long stepCount() const { return step_count_; }
  double stepS() const { return step_s_; }

  /// It is t_0 = start_s, and nothing has been counted.
  void start(double start_s) {
    start_s_ = start_s;
    step_count_ = internal_count_ = 0;
  }
  void countInternalStep(double h_s) {
    internal_step_s_ = h_s;
    ++internal_count_;
  }
  /// The internal steps counted make a whole control step.
  void countStep() {
    ++step_count_;
    internal_count_ = 0;
  }
  /// The internal steps counted make up this duration, which is not a whole number of control steps.
  void shift(double duration_s) {
    start_s_ += duration_s;
    internal_count_ = 0;
  }

 private:
  double step_s_, start_s_ = 0, internal_step_s_ = 0;
  long step_count_ = 0, internal_count_ = 0;
};

}  // namespace musclesim
