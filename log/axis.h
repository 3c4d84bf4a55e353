/// Axes of a figure: ranges, ticks at round numbers, and positions in pixels.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

/// The least and the greatest of the finite numbers added so far.
class Extent {
 public:
  void add(double value);
  void add(const std::vector<double>& values);
  bool empty() const { return empty_; }
  double minimum() const { return minimum_; }
  double maximum() const { return maximum_; }

 private:
  bool empty_ = true;
  double minimum_ = 0, maximum_ = 1;
};

/// Maps numbers to pixels. Ticks are multiples of 1, 2 or 5 times a power of ten.
class Axis {
 public:
  /// Makes about `tick_count` ticks. With `round_ends` the range grows to the next tick at both ends; otherwise only to a tick within 1 %
  /// of the range. An extent of zero width is widened.
  Axis(const Extent& extent, double first_pixel, double last_pixel, int tick_count, bool round_ends);

  double minimum() const { return minimum_; }
  double maximum() const { return maximum_; }
  /// Numbers outside the range lie beyond the ends, by at most the length of the axis.
  double pixel(double value) const;
  const std::vector<double>& ticks() const { return ticks_; }
  /// The text of a tick's number, with as many digits as the ticks need.
  std::string label(double tick) const;

 private:
  double minimum_ = 0, maximum_ = 1, step_ = 1;
  double first_pixel_ = 0, last_pixel_ = 1;
  std::vector<double> ticks_;
};

}  // namespace musclesim
