#include "waves.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

double fraction(double cycles) {
  return cycles - std::floor(cycles);
}

}  // namespace

double triangleWave(double cycles) {
  const double phase = fraction(cycles);
  return phase < 0.5 ? 4 * phase - 1 : 3 - 4 * phase;
}

double squareWave(double cycles) {
  return fraction(cycles) < 0.5 ? 1 : -1;
}

double Chirp::cycles(double time_s) const {
  const double t = std::min(time_s, sweep_s), beyond_s = std::max(0.0, time_s - sweep_s);
  const double log_ratio = std::log(to_Hz / from_Hz);
  const bool is_log = logarithmic && log_ratio != 0;
  const double swept = is_log ? from_Hz * sweep_s * std::expm1(log_ratio * t / sweep_s) / log_ratio
                              : from_Hz * t + (to_Hz - from_Hz) * t * t / (2 * sweep_s);
  return swept + to_Hz * beyond_s;
}

double Chirp::at(double time_s) const {
  return std::sin(two_pi * cycles(time_s));
}

double stairsWave(double time_s, double hold_s, int step_count) {
  const double n = step_count;
  const double k = std::fmod(std::floor(time_s / hold_s), 2 * n);
  return -1 + 2 * (n - std::abs(k - n)) / n;
}

double reversalsWave(double time_s, double period_s, int loop_count) {
  double left_s = std::fmod(time_s, period_s * (loop_count + 1) / 2);
  for (int m = 0;; ++m) {
    const double size = 1 - static_cast<double>(m) / loop_count;
    const bool is_last = m + 1 == loop_count;
    // A quarter of a cycle later the triangle passes 0 on its way up.
    if (left_s < size * period_s || is_last) return size * triangleWave(left_s / (size * period_s) + 0.25);
    left_s -= size * period_s;
  }
}

BinarySequence::BinarySequence(int order, std::uint64_t offset) {
  // Exponents of primitive polynomials x^n + x^m (+ x^k + x^j) + 1 for n = 2 .. 12; 0: no further term.
  static constexpr std::array<std::array<int, 3>, 11> further = {
      {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {3, 0, 0}, {5, 0, 0}, {6, 0, 0}, {6, 5, 4}, {5, 0, 0}, {7, 0, 0}, {9, 0, 0}, {6, 4, 1}}};
  if (order < smallest_order || order > largest_order)
    throw BadParameter("order of a binary sequence", fmt::format("{}", order),
                       fmt::format("lie in {} .. {}", smallest_order, largest_order));
  const std::size_t length = (std::size_t{1} << order) - 1;
  bits_.assign(length, true);
  const auto n = static_cast<std::size_t>(order);
  for (std::size_t k = n; k < length; ++k) {
    bool bit = bits_[k - n];
    for (const int m : further[n - smallest_order])
      if (m > 0) bit = bit != bits_[k - static_cast<std::size_t>(m)];
    bits_[k] = bit;
  }
  offset_ = static_cast<std::size_t>(offset % length);
}

double BinarySequence::at(long k) const {
  return bits_[(static_cast<std::size_t>(k) + offset_) % bits_.size()] ? 1 : -1;
}

std::vector<int> Multisine::harmonics(double low_Hz, double high_Hz, double period_s) {
  constexpr double rounding = 1e-9;  ///< 0.1 Hz times 10 s is a whole number
  constexpr double most = 10000;
  const double first = std::max(1.0, std::ceil(low_Hz * period_s - rounding)), last = std::floor(high_Hz * period_s + rounding);
  if (!(last >= first && last <= most))
    throw BadParameter("band of the multisine", fmt::format("{} .. {} Hz with a period of {} s", low_Hz, high_Hz, period_s),
                       fmt::format("hold 1 to {} multiples of 1/period", most));
  std::vector<int> result;
  for (double m = first; m <= last; ++m) result.push_back(static_cast<int>(m));
  return result;
}

std::vector<double> Multisine::schroederPhases(std::size_t count) {
  std::vector<double> phases;
  for (std::size_t i = 1; i <= count; ++i)
    phases.push_back(-std::numbers::pi * static_cast<double>(i * (i - 1)) / static_cast<double>(count));
  return phases;
}

Multisine::Multisine(std::vector<int> harmonics, std::vector<double> phases, double period_s)
    : harmonics_(std::move(harmonics)), phases_(std::move(phases)), period_s_(period_s) {
  scale_ = 1 / peak();
}

std::vector<double> Multisine::samples(std::size_t count) const {
  std::vector<std::complex<double>> spectrum(count), values;
  for (std::size_t i = 0; i < harmonics_.size(); ++i) spectrum[static_cast<std::size_t>(harmonics_[i])] = std::polar(1.0, phases_[i]);
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::Unscaled);
  transform.inv(values, spectrum);
  std::vector<double> result;
  for (const std::complex<double>& value : values) result.push_back(value.real());
  return result;
}

double Multisine::peak() const {
  constexpr std::size_t points_per_cycle = 64;  ///< of the highest frequency; the peak between two points is at most 0.12 % higher
  // Samples of a power of two are transformed fast. The largest of the points lies beside one of them that is at most 0.48 % smaller: 0.12
  // % below the peak a sum of sines has at most a twentieth of its largest slope.
  constexpr double nearly = 0.995;
  const std::size_t count = points_per_cycle * static_cast<std::size_t>(harmonics_.back());
  const std::vector<double> dense = samples(std::bit_ceil(count));
  double dense_peak = 0, peak = 0;
  for (const double value : dense) dense_peak = std::max(dense_peak, std::abs(value));
  std::size_t next = 0;  // point that was not looked at
  for (std::size_t k = 0; k < dense.size(); ++k) {
    if (std::abs(dense[k]) < nearly * dense_peak) continue;
    const std::size_t before = k * count / dense.size();
    for (std::size_t i = std::max(before, next); i <= before + 1; ++i, next = i)
      peak = std::max(peak, std::abs(sum(period_s_ * static_cast<double>(i) / static_cast<double>(count))));
  }
  return peak;
}

double Multisine::sum(double time_s) const {
  double sum = 0;
  for (std::size_t i = 0; i < harmonics_.size(); ++i) sum += std::cos(two_pi * harmonics_[i] * (time_s / period_s_) + phases_[i]);
  return sum;
}

double Multisine::at(double time_s) const {
  return std::clamp(scale_ * sum(time_s), -1.0, 1.0);
}

}  // namespace musclesim
