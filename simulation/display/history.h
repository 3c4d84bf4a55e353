/// The last seconds of a run, for live plots.
#pragma once

#include <deque>

#include "simulation/snapshot.h"

namespace musclesim {

class History {
 public:
  static constexpr double duration_s = 20;

  struct Sample {
    State state;
    std::optional<double> activity, target_height_mm;
  };

  /// Adds a snapshot, unless its time equals that of the last one.
  void add(const Snapshot& snapshot);
  const std::deque<Sample>& samples() const { return samples_; }

 private:
  std::deque<Sample> samples_;
};

}  // namespace musclesim
