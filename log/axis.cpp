#include "axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace musclesim {

namespace {

/// Larger numbers are drawn at this limit, so that differences cannot overflow.
constexpr double largest_number = 1e150;
/// The least width of a range, relative to its numbers, for which tick labels differ.
constexpr double narrowest_ratio = 1e-9;

/// An end of the range moves to a tick that is nearer than this, relative to the range.
constexpr double near_ratio = 0.01;

/// The smallest of 1, 2, 5 times a power of ten that is not below `least`.
double roundStep(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least * (1 - narrowest_ratio)) return factor * power;
  return 10 * power;
}

}  // namespace

void Extent::add(double value) {
  if (!std::isfinite(value)) return;
  const double drawn = std::clamp(value, -largest_number, largest_number);
  minimum_ = empty_ ? drawn : std::min(minimum_, drawn);
  maximum_ = empty_ ? drawn : std::max(maximum_, drawn);
  empty_ = false;
}

void Extent::add(const std::vector<double>& values) {
  for (const double value : values) add(value);
}

Axis::Axis(const Extent& extent, double first_pixel, double last_pixel, int tick_count, bool round_ends)
    : minimum_(extent.minimum()), maximum_(extent.maximum()), first_pixel_(first_pixel), last_pixel_(last_pixel) {
  const double magnitude = std::max({std::abs(minimum_), std::abs(maximum_), 1e-150});
  if (maximum_ - minimum_ < narrowest_ratio * magnitude) {
    const double half_width = extent.minimum() == 0 && extent.maximum() == 0 ? 0.5 : magnitude / 20;
    minimum_ -= half_width;
    maximum_ += half_width;
  }
  step_ = roundStep((maximum_ - minimum_) / tick_count);
  const double near = round_ends ? 1 - narrowest_ratio : std::max(near_ratio * (maximum_ - minimum_) / step_, narrowest_ratio);
  const double first = std::ceil(minimum_ / step_ - near);
  const double last = std::floor(maximum_ / step_ + near);
  for (double count = 0; first + count <= last && count <= 4.0 * tick_count; ++count) ticks_.push_back((first + count) * step_);
  if (ticks_.size() < 2) return;
  minimum_ = round_ends ? ticks_.front() : std::min(minimum_, ticks_.front());
  maximum_ = round_ends ? ticks_.back() : std::max(maximum_, ticks_.back());
}

double Axis::pixel(double value) const {
  const double ratio = std::clamp((std::clamp(value, -largest_number, largest_number) - minimum_) / (maximum_ - minimum_), -1.0, 2.0);
  return first_pixel_ + ratio * (last_pixel_ - first_pixel_);
}

std::string Axis::label(double tick) const {
  const double largest = std::max(std::abs(minimum_), std::abs(maximum_));
  if (std::abs(tick) < step_ / 2) return "0";
  std::string text;
  if (largest >= 1e10 || step_ < 1e-5) {
    const auto digits = static_cast<int>(std::ceil(std::log10(largest / step_))) + 1;
    text = fmt::format("{:.{}g}", tick, std::clamp(digits, 1, 12));
  } else {
    const auto decimals = static_cast<int>(-std::floor(std::log10(step_) + narrowest_ratio));
    text = fmt::format("{:.{}f}", tick, std::max(decimals, 0));
  }
  constexpr const char* minus_sign = "\u2212";
  return text.front() == '-' ? minus_sign + text.substr(1) : text;
}

}  // namespace musclesim
