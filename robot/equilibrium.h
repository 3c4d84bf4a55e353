/// Root finders for equilibria: zeros of a force or torque over a position.
#pragma once

#include <algorithm>

namespace musclesim {

/// Root of an increasing function on low..high, by bisection to the last bit. Without a change of sign it returns the end nearer to the
/// root.
template <class Function>
double rootBetween(const Function& f, double low, double high) {
  if (f(low) >= 0) return low;
  if (f(high) <= 0) return high;
  while (true) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) return middle;
    (f(middle) < 0 ? low : high) = middle;
  }
}

/// Rest position of something that starts between low and high and is pushed up while f < 0 and down while f > 0. It is the first root on
/// the way, searched in 64 equal steps, or the end of the range if there is no root.
template <class Function>
double restFrom(const Function& f, double start, double low, double high) {
  constexpr int step_count = 64;
  start = std::clamp(start, low, high);
  if (f(start) == 0) return start;
  const bool up = f(start) < 0;
  const double end = up ? high : low;
  double last = start;
  for (int i = 1; i <= step_count; ++i) {
    const double next = i == step_count ? end : start + (end - start) * i / step_count;
    if ((f(next) < 0) != up) return rootBetween(f, std::min(last, next), std::max(last, next));
    last = next;
  }
  return end;
}

}  // namespace musclesim
