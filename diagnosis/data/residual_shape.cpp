#include "residual_shape.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace musclesim {

namespace {

constexpr Eigen::Index fewest_rows = 64;
constexpr double enough_power = 0.5;  ///< least share of the power for a shape to be named

bool evenlySpaced(const Eigen::VectorXd& time_s) {
  const Eigen::Index last = time_s.size() - 1;
  const double step_s = (time_s[last] - time_s[0]) / static_cast<double>(last);
  for (Eigen::Index i = 0; i <= last; ++i)
    if (std::abs(time_s[i] - time_s[0] - static_cast<double>(i) * step_s) > 0.1 * step_s) return false;
  return step_s > 0;
}

/// Power of evenly spaced rows at the frequencies 1 / T, 2 / T, ... from `first_hz` on, 0 below it. All powers add up to that of the rows.
std::vector<double> spectrum(const Eigen::VectorXd& residual, double step_s, double first_hz) {
  const Eigen::Index count = residual.size();
  const double duration_s = static_cast<double>(count) * step_s;
  std::vector<double> power(static_cast<std::size_t>(count / 2), 0);
  for (auto k = static_cast<std::size_t>(std::ceil(first_hz * duration_s)); k < power.size(); ++k) {
    const std::complex<double> turn = std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count));
    std::complex<double> sum = 0, phase = 1;
    for (const double r : residual) {
      sum += r * phase;
      phase *= turn;
    }
    power[k] = 2 * std::norm(sum) / static_cast<double>(count);
  }
  return power;
}

ResidualDescription rippleIn(const Eigen::VectorXd& residual, double step_s, double all_power) {
  constexpr double lowest_hz = 2, band = 0.1;
  const std::vector<double> power = spectrum(residual, step_s, lowest_hz);
  const auto peak = std::ranges::max_element(power);
  if (peak == power.end() || *peak == 0) return {};
  const auto at = static_cast<double>(peak - power.begin());
  double within = 0, weighted = 0;
  for (std::size_t k = 0; k < power.size(); ++k) {
    if (std::abs(static_cast<double>(k) - at) > std::max(1.0, band * at)) continue;
    within += power[k];
    weighted += power[k] * static_cast<double>(k);
  }
  if (within < enough_power * all_power) return {};
  return {ResidualShape::ripple, weighted / within / (static_cast<double>(residual.size()) * step_s)};
}

/// The median of the times between rows.
double usualStep(const std::vector<double>& times) {
  std::vector<double> steps(times.size());
  std::adjacent_difference(times.begin(), times.end(), steps.begin());
  steps.erase(steps.begin());
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

/// Rows at whole multiples of a step from the first, NaN where there is none. Empty if rows lie between the multiples, or if pauses take
/// far more time than the rows.
std::vector<double> onGrid(const std::vector<double>& times, const std::vector<double>& values, double step_s) {
  constexpr double beside = 0.1;  // steps
  constexpr double most_steps_per_row = 10;
  std::vector<double> grid;
  if (times.back() - times.front() > most_steps_per_row * step_s * static_cast<double>(times.size())) return {};
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double steps = (times[i] - times.front()) / step_s;
    if (std::abs(steps - std::round(steps)) > beside) return {};
    grid.resize(static_cast<std::size_t>(std::lround(steps)) + 1, std::nan(""));
    grid.back() = values[i];
  }
  return grid;
}

/// The shift in time that leaves least of the difference between measured and simulated rows, compared with what they leave unshifted at
/// the same times.
ResidualDescription shiftBetween(const std::vector<double>& times, const std::vector<double>& measured,
                                 const std::vector<double>& simulated, double step_s) {
  constexpr double longest_s = 1;
  const std::vector<double> readings = onGrid(times, measured, step_s), expected = onGrid(times, simulated, step_s);
  const auto count = static_cast<long>(expected.size());
  const long most = std::min(count / 4, std::lround(longest_s / step_s));
  ResidualDescription best;
  double least_left = 1 - enough_power;
  for (long late = -most; late <= most; ++late) {
    double shifted = 0, unshifted = 0;
    for (long i = std::max(0L, late); i < count + std::min(0L, late); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double reading = readings[at], beside = reading - expected[at], moved = reading - expected[static_cast<std::size_t>(i - late)];
      if (!std::isfinite(beside) || !std::isfinite(moved)) continue;
      unshifted += beside * beside;
      shifted += moved * moved;
    }
    if (shifted > least_left * unshifted || unshifted == 0) continue;
    least_left = shifted / unshifted;
    best = {ResidualShape::shift, static_cast<double>(late) * step_s};
  }
  return best;
}

}  // namespace

ResidualDescription describeResidual(const std::vector<double>& time_s, const std::vector<double>& measured,
                                     const std::vector<double>& simulated) {
  std::vector<double> times, values, readings, expected;
  for (std::size_t i = 0; i < std::min({time_s.size(), measured.size(), simulated.size()}); ++i)
    if (const double r = measured[i] - simulated[i]; std::isfinite(r)) {
      times.push_back(time_s[i]);
      values.push_back(r);
      readings.push_back(measured[i]);
      expected.push_back(simulated[i]);
    }
  const auto count = static_cast<Eigen::Index>(values.size());
  if (count < fewest_rows) return {};
  const Eigen::VectorXd t = Eigen::Map<const Eigen::VectorXd>(times.data(), count);
  const Eigen::VectorXd residual = Eigen::Map<const Eigen::VectorXd>(values.data(), count);
  const double all_power = residual.squaredNorm(), mean = residual.mean();
  if (!(all_power > 0)) return {};
  if (mean * mean * static_cast<double>(count) >= enough_power * all_power) return {ResidualShape::offset, mean};
  const Eigen::VectorXd centred_time = t.array() - t.mean(), centred = residual.array() - mean;
  const double slope = centred_time.dot(centred) / centred_time.squaredNorm();
  if (slope * slope * centred_time.squaredNorm() >= enough_power * all_power) return {ResidualShape::drift, slope};
  const double step_s = usualStep(times);
  if (const auto shift = shiftBetween(times, readings, expected, step_s); shift.shape != ResidualShape::none) return shift;
  return evenlySpaced(t) ? rippleIn(centred, step_s, all_power) : ResidualDescription{};
}

std::string wordsFor(const ResidualDescription& description) {
  switch (description.shape) {
    case ResidualShape::none:
      return "";
    case ResidualShape::offset:
      return fmt::format("mostly an offset of {:.2g}", description.value);
    case ResidualShape::drift:
      return fmt::format("mostly a drift of {:.2g} per second", description.value);
    case ResidualShape::shift:
      return description.value < 0
                 ? fmt::format("mostly because it comes {:.2g} s early (no effect does that; compare the clocks of the loggers)",
                               -description.value)
                 : fmt::format("mostly because it comes {:.2g} s late", description.value);
    case ResidualShape::ripple:
      return fmt::format("mostly a ripple of {:.2g} Hz", description.value);
  }
  return "";
}

}  // namespace musclesim
