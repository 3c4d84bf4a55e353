#include "history.h"

namespace musclesim {

void History::add(const Snapshot& snapshot) {
  if (!samples_.empty() && samples_.back().state.time_s >= snapshot.state.time_s) return;
  Sample sample{snapshot.state, snapshot.activity, std::nullopt};
  if (snapshot.target) sample.target_height_mm = snapshot.target->point_mm.y();
  samples_.push_back(std::move(sample));
  while (samples_.back().state.time_s - samples_.front().state.time_s > duration_s) samples_.pop_front();
}

}  // namespace musclesim
