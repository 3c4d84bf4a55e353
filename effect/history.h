/// Past values of a signal, for effects that need them.
#pragma once

#include <deque>

namespace musclesim {

/// A piecewise constant signal: each value holds until the next.
class HeldHistory {
 public:
  void clear() { changes_.clear(); }
  /// Sets a constant value for all times and forgets all others.
  void holdForEver(double value);
  /// Sets the value from time_s on. Times must not decrease.
  void hold(double time_s, double value);
  double at(double time_s) const;
  /// Mean over from_s .. to_s; the last value continues to hold.
  double mean(double from_s, double to_s) const;
  /// Drops values that are not needed for times from time_s on.
  void forgetBefore(double time_s);

 private:
  struct Change {
    double time_s, value;
  };
  std::deque<Change> changes_;
};

/// Samples of a continuous signal, interpolated linearly.
class SampledHistory {
 public:
  void clear() { samples_.clear(); }
  /// Times must not decrease; a second sample for the same time replaces the first.
  void add(double time_s, double value);
  /// The first sample holds before its time, the last after it.
  double at(double time_s) const;
  void forgetBefore(double time_s);
  bool empty() const { return samples_.empty(); }

 private:
  struct Sample {
    double time_s, value;
  };
  std::deque<Sample> samples_;
};

}  // namespace musclesim
