/// Helpers of the controller tests: a request with its own parameters, and states with a hand.
#pragma once

#include <initializer_list>
#include <string>

#include "musclesim/controller/controller.h"

namespace musclesim::test {

/// Parameters and the request that refers to them; four steps per decision unless changed.
struct Prepared {
  Parameters parameters;
  ControllerRequest request{parameters, 2, 0.01, 0.04, 1, "height", std::nullopt};

  explicit Prepared(std::initializer_list<std::string> assignments = {}) {
    for (const auto& assignment : assignments) parameters.setFromText(assignment, "test");
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;
};

inline State atTime(double time_s) {
  State state;
  state.time_s = time_s;
  return state;
}

inline State stateWithHand(const Vector& hand_mm, double time_s = 0) {
  State state;
  state.time_s = time_s;
  state.hand_mm = hand_mm;
  return state;
}

/// A hand that misses the default targets in one direction only: by `height_mm` for the height task.
inline State stateAtHeight(double height_mm) {
  return stateWithHand({-200, height_mm, 0});
}

inline bool allInUnitRange(const Action& action) {
  for (const double p : action)
    if (!(p >= 0 && p <= 1)) return false;  // NaN fails too
  return true;
}

}  // namespace musclesim::test
