/// Where a function that grows from negative to positive crosses zero.
#pragma once

namespace musclesim {

/// Root of an increasing function on low..high by bisection to the last bit; the nearer end where there is no change of sign.
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

}  // namespace musclesim
