#include "noise_sigma.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "data_checks.h"

namespace musclesim {

namespace {

constexpr double normal_per_median = 1.4826;  ///< standard deviation of a normal distribution / median absolute deviation

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Sum and number of the squared differences of one signal.
struct Differences {
  double sum_of_squares = 0;
  long count = 0;
  void add(double difference) {
    if (!std::isfinite(difference)) return;
    sum_of_squares += difference * difference;
    ++count;
  }
};

struct Interpolated {
  double value, noise_share;  ///< noise_share: share of the noise variance of one row; less between two rows
};

/// Linear interpolation between the rows before and after a time; NaN outside the recording.
Interpolated interpolated(const std::vector<double>& time_s, const std::vector<double>& values, double at_s) {
  const auto after = std::ranges::upper_bound(time_s, at_s);
  if (after == time_s.begin()) return {std::nan(""), 1};
  const auto i = static_cast<std::size_t>(after - time_s.begin()) - 1;
  if (at_s == time_s[i]) return {values[i], 1};
  if (after == time_s.end()) return {std::nan(""), 1};
  const double share = (at_s - time_s[i]) / (time_s[i + 1] - time_s[i]);
  return {values[i] + share * (values[i + 1] - values[i]), share * share + (1 - share) * (1 - share)};
}

/// From recordings with the same commands at the same times, and from those that a sidecar calls repeats, whose times may differ.
std::optional<double> fromRepeats(const std::vector<Recording>& recordings, const std::string& name) {
  Differences differences;
  for (std::size_t i = 0; i < recordings.size(); ++i)
    for (std::size_t j = i + 1; j < recordings.size(); ++j) {
      const Recording &first = recordings[i], &second = recordings[j];
      const Signal *a = first.find(name), *b = second.find(name);
      if (!a || !b || !isRepeat(first, second)) continue;
      for (std::size_t row = 0; row < a->values.size(); ++row) {
        const Interpolated other = interpolated(second.time_s, b->values, first.time_s[row]);
        differences.add((a->values[row] - other.value) * std::sqrt(2 / (1 + other.noise_share)));
      }
    }
  if (differences.count < 20) return std::nullopt;
  return std::sqrt(differences.sum_of_squares / static_cast<double>(differences.count) / 2);
}

std::optional<double> fromSidecars(const std::vector<Recording>& recordings, const std::string& name) {
  double sum = 0;
  int count = 0;
  for (const Recording& recording : recordings) {
    const auto given = recording.info.noise_std.find(name);
    if (given == recording.info.noise_std.end() || !(given->second > 0)) continue;
    sum += given->second;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

/// A central difference of white noise has the variance of the noise times the sum of the squared factors.
struct DifferenceOrder {
  std::array<double, 5> factors;
  double sum_of_squares;
};
constexpr DifferenceOrder second = {{0, 1, -2, 1, 0}, 6}, fourth = {{1, -4, 6, -4, 1}, 70};

/// Differences of the rows whose neighbourhood moves least; they cancel a straight line (second) or a cubic (fourth) and leave the noise.
/// Rows without a number are skipped, since a signal may be read less often than others; if asked, so are rows that repeat the value
/// before.
std::vector<double> quietDifferences(const Recording& recording, const std::string& name, bool without_held, const DifferenceOrder& order) {
  constexpr std::size_t half_window = 10;
  const Signal* signal = recording.find(name);
  if (!signal) return {};
  std::vector<double> y = signal->values;
  std::erase_if(y, [](double value) { return !std::isfinite(value); });
  if (without_held) y.erase(std::unique(y.begin(), y.end()), y.end());
  std::vector<std::pair<double, double>> by_speed;
  for (std::size_t i = half_window; i + half_window < y.size(); ++i) {
    double difference = 0;
    for (std::size_t k = 0; k < order.factors.size(); ++k) difference += order.factors[k] * y[i + k - 2];
    by_speed.emplace_back(std::abs(y[i + half_window] - y[i - half_window]), difference);
  }
  std::sort(by_speed.begin(), by_speed.end());
  std::vector<double> result;
  for (std::size_t i = 0; i < by_speed.size() / 2; ++i) result.push_back(by_speed[i].second);
  return result;
}

double fromDifferences(const std::vector<Recording>& recordings, const std::string& name, bool without_held, const DifferenceOrder& order) {
  std::vector<double> all;
  for (const Recording& recording : recordings) {
    const auto some = quietDifferences(recording, name, without_held, order);
    all.insert(all.end(), some.begin(), some.end());
  }
  const double middle = median(all);
  for (double& value : all) value = std::abs(value - middle);
  return normal_per_median * median(all) / std::sqrt(order.sum_of_squares);
}

/// Of a swing with the frequency f in rows h apart, second differences keep (2 pi f h)^2 of the amplitude and fourth ones (2 pi f h)^4:
/// where those are much smaller, the second ones are motion. White noise gives both the same.
double fromQuietRows(const std::vector<Recording>& recordings, const std::string& name, bool without_held) {
  constexpr double much_smaller = 0.5;
  const double by_second = fromDifferences(recordings, name, without_held, second);
  const double by_fourth = fromDifferences(recordings, name, without_held, fourth);
  return by_fourth < much_smaller * by_second ? by_fourth : by_second;
}

double rangeOf(const std::vector<Recording>& recordings, const std::string& name) {
  double least = std::numeric_limits<double>::infinity(), largest = -least;
  for (const Recording& recording : recordings)
    if (const Signal* signal = recording.find(name))
      for (const double value : signal->values)
        if (std::isfinite(value)) least = std::min(least, value), largest = std::max(largest, value);
  return largest > least ? largest - least : 0;
}

/// Share of the rows that repeat the value of the row before.
double heldShare(const std::vector<Recording>& recordings, const std::string& name) {
  double held = 0, count = 0;
  for (const Recording& recording : recordings)
    if (const Signal* signal = recording.find(name))
      for (std::size_t row = 1; row < signal->values.size(); ++row) {
        if (!std::isfinite(signal->values[row])) continue;
        ++count;
        held += signal->values[row] == signal->values[row - 1] ? 1 : 0;
      }
  return count > 0 ? held / count : 0;
}

double finestLattice(const std::vector<Recording>& recordings, const std::string& name) {
  double step = 0;
  for (const Recording& recording : recordings)
    if (const Signal* signal = recording.find(name)) step = std::max(step, latticeStep(signal->values));
  return step;
}

}  // namespace

double latticeStep(const std::vector<double>& values) {
  constexpr std::size_t fewest_levels = 8;  // fewer levels prove no lattice
  std::vector<double> sorted;
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  std::sort(sorted.begin(), sorted.end());
  double step = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double difference = sorted[i] - sorted[i - 1];
    if (difference > 1e-9 && (step == 0 || difference < step)) step = difference;
  }
  std::size_t levels = 1;
  for (std::size_t i = 1; i < sorted.size(); ++i) levels += sorted[i] - sorted[i - 1] > 1e-9 ? 1 : 0;
  if (step == 0 || levels < fewest_levels) return 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double multiple = (sorted[i] - sorted[0]) / step;
    if (std::abs(multiple - std::round(multiple)) > 0.05 + 1e-6 * multiple) return 0;
  }
  return step;
}

NoiseSigma noiseSigma(const std::vector<Recording>& recordings, const std::string& name) {
  constexpr double usual_share = 1e-3, finest_share = 1e-5;  // of the range; a converter of 16 bits has steps of 1.5e-5
  constexpr double held_by_chance = 0.1, fine_lattice = 4;   // noise of four lattice steps makes 7 % of neighbours equal
  const double range = rangeOf(recordings, name), imperceptible = std::max(1e-9, finest_share * range);
  const double least = std::max(finestLattice(recordings, name) / std::sqrt(12.0), 1e-9);
  if (const auto repeats = fromRepeats(recordings, name)) return {std::max(*repeats, least), NoiseSigma::Source::repeats};
  if (const auto sidecar = fromSidecars(recordings, name)) return {std::max(*sidecar, least), NoiseSigma::Source::sidecar};
  const double quiet = std::max(fromQuietRows(recordings, name, false), least), changed = fromQuietRows(recordings, name, true);
  // Many repeated values that chance does not explain come from a sensor that is read less often than it is logged.
  const bool is_held = heldShare(recordings, name) > held_by_chance && changed > fine_lattice * finestLattice(recordings, name);
  if (!is_held && quiet > imperceptible) return {quiet, NoiseSigma::Source::quiet_rows};
  if (changed > imperceptible) return {std::max(changed, least), NoiseSigma::Source::quiet_rows};
  return {std::max(usual_share * range, least), NoiseSigma::Source::range};
}

}  // namespace musclesim
