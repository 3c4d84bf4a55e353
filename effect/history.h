/// What a signal has been, for effects that look back.
#pragma once

#include <deque>

namespace musclesim {

/// A value that is held until the next one.
class HeldHistory {
 public:
  void clear() { changes_.clear(); }
  /// Forgets everything else.
  void holdForEver(double value);
  /// From time_s on the value is `value`. Times must not decrease.
  void hold(double time_s, double value);
  double at(double time_s) const;
  /// Mean over from_s .. to_s; the last value holds on.
  double mean(double from_s, double to_s) const;
  /// Drops what lies before a time.
  void forgetBefore(double time_s);

 private:
  struct Change {
    double time_s, value;
  };
  std::deque<Change> changes_;
};

/// Samples of a value that changes steadily, joined by straight lines.
class SampledHistory {
 public:
  void clear() { samples_.clear(); }
  /// Times must not decrease; a second sample for one time replaces the first.
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
