#include "history.h"

#include <algorithm>
#include <limits>

namespace musclesim {

namespace {

/// Tolerance for rounding errors of times: a change counts as reached this long before its time.
constexpr double rounding_s = 1e-9;

}  // namespace

void HeldHistory::holdForEver(double value) {
  changes_.assign(1, {-std::numeric_limits<double>::infinity(), value});
}

void HeldHistory::hold(double time_s, double value) {
  if (changes_.empty()) return holdForEver(value);
  if (changes_.back().value == value) return;
  if (changes_.back().time_s == time_s)
    changes_.back().value = value;
  else
    changes_.push_back({time_s, value});
}

double HeldHistory::at(double time_s) const {
  for (auto change = changes_.rbegin(); change != changes_.rend(); ++change)
    if (change->time_s <= time_s + rounding_s) return change->value;
  return changes_.front().value;
}

double HeldHistory::mean(double from_s, double to_s) const {
  double sum = 0, end_s = to_s;
  for (auto change = changes_.rbegin(); change != changes_.rend() && end_s > from_s; ++change) {
    if (change->time_s >= end_s - rounding_s) continue;
    // Usual case, no change in the interval: returns the value itself without rounding errors.
    if (end_s == to_s && change->time_s <= from_s + rounding_s) return change->value;
    const double begin_s = std::max(change->time_s, from_s);
    sum += (end_s - begin_s) * change->value;
    end_s = begin_s;
  }
  return sum / (to_s - from_s);
}

void HeldHistory::forgetBefore(double time_s) {
  while (changes_.size() > 1 && changes_[1].time_s <= time_s - rounding_s) changes_.pop_front();
}

void SampledHistory::add(double time_s, double value) {
  if (!samples_.empty() && samples_.back().time_s >= time_s)
    samples_.back().value = value;
  else
    samples_.push_back({time_s, value});
}

double SampledHistory::at(double time_s) const {
  const auto after =
      std::lower_bound(samples_.begin(), samples_.end(), time_s, [](const Sample& sample, double time) { return sample.time_s < time; });
  if (after == samples_.begin()) return samples_.front().value;
  if (after == samples_.end()) return samples_.back().value;
  const Sample &before = *(after - 1), &next = *after;
  return before.value + (next.value - before.value) * (time_s - before.time_s) / (next.time_s - before.time_s);
}

void SampledHistory::forgetBefore(double time_s) {
  while (samples_.size() > 2 && samples_[1].time_s <= time_s) samples_.pop_front();
}

}  // namespace musclesim
