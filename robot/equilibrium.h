/// Root finders for equilibria: zeros of a force or torque over a position.
#pragma once

#include <algorithm>
#include <cmath>

namespace musclesim {

/// Root of an increasing function on low..high, to the last bit. Without a change of sign it returns the end nearer to the root.
///
/// Two secants between the ends, then a bisection, and so on; an end that stays twice counts half (the Illinois algorithm: Dowell & Jarratt
/// 1971, BIT 11). Some twenty values of a smooth function are needed, where bisection alone needs fifty.
template <class Function>
double rootBetween(const Function& f, double low, double high) {
  double at_low = f(low);
  if (at_low >= 0) return low;
  double at_high = f(high);
  if (at_high <= 0) return high;
  bool low_moved = false, high_moved = false;
  for (int i = 1;; ++i) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) return middle;
    const double secant = low - at_low * (high - low) / (at_high - at_low);
    const double next = i % 3 != 0 && secant > low && secant < high ? secant : middle;
    const double at_next = f(next);
    if (at_next == 0) return next;
    if (at_next < 0) {
      if (low_moved) at_high /= 2;
      low = next;
      at_low = at_next;
    } else {
      if (high_moved) at_low /= 2;
      high = next;
      at_high = at_next;
    }
    low_moved = at_next < 0;
    high_moved = !low_moved;
  }
}

/// Rest position of something that starts between low and high and is pushed up while f < 0 and down while f > 0. It is the first root on
/// the way, searched in 64 equal steps, or the end of the range if there is no root. Where the range has no end on that side, 175 steps
/// grow by 5 % each from 1, which leads to 1e5, and the result is infinite if there is no root.
template <class Function>
double restFrom(const Function& f, double start, double low, double high) {
  constexpr double growth = 1.05;
  start = std::clamp(start, low, high);
  const double push_back = f(start);
  if (push_back == 0) return start;
  const bool up = push_back < 0;
  const double end = up ? high : low;
  const bool is_open = std::isinf(end);
  const int step_count = is_open ? 175 : 64;
  double last = start, way = 0;
  for (int i = 1; i <= step_count; ++i) {
    way = 1 + growth * way;
    const double next = is_open ? start + (up ? way : -way) : i == step_count ? end : start + (end - start) * i / step_count;
    if ((f(next) < 0) != up) return rootBetween(f, std::min(last, next), std::max(last, next));
    last = next;
  }
  return end;
}

}  // namespace musclesim
