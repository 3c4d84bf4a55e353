#include "replay_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "noise_sigma.h"

namespace musclesim {

double ReplayGap::residual(std::size_t row) const {
  return row < simulated.size() ? measured[row] - simulated[row] : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> ReplayGap::residuals() const {
  std::vector<double> all;
  for (std::size_t row = 0; row < measured.size(); ++row) all.push_back(residual(row));
  return all;
}

double ReplayGap::rmse() const {
  double sum_of_squares = 0;
  long count = 0;
  for (const double value : residuals()) {
    if (!std::isfinite(value)) continue;
    sum_of_squares += value * value;
    ++count;
  }
  return count > 0 ? std::sqrt(sum_of_squares / static_cast<double>(count)) : 0;
}

std::vector<std::pair<double, double>> ReplayGap::outsideS() const {
  std::vector<std::pair<double, double>> intervals;
  int side = 0, row_count = 0;
  double first_s = 0, last_s = 0;
  const auto end = [&] {
    if (side != 0 && row_count > 1) intervals.emplace_back(first_s, last_s);
  };
  for (std::size_t row = 0; row < measured.size(); ++row) {
    const double value = residual(row);
    if (!std::isfinite(value)) continue;
    const int side_here = value > band() ? 1 : value < -band() ? -1 : 0;
    if (side_here != side) {
      end();
      side = side_here;
      row_count = 0;
      first_s = time_s[row];
    }
    ++row_count;
    last_s = time_s[row];
  }
  end();
  return intervals;
}

std::vector<ReplayGap> replayGaps(const Recording& measured, const Recording& simulated) {
  std::vector<ReplayGap> gaps;
  for (const Signal& signal : simulated.signals) {
    const Signal* other = measured.find(signal.name);
    const auto isNumber = [](double value) { return std::isfinite(value); };
    if (!other || signal.name.starts_with("command_") || std::ranges::none_of(other->values, isNumber)) continue;
    gaps.push_back({signal.name, measured.time_s, other->values, signal.values, noiseSigma({measured}, signal.name).value});
  }
  return gaps;
}

int widestGap(const std::vector<ReplayGap>& gaps) {
  if (gaps.empty()) return -1;
  const auto widest = std::ranges::max_element(gaps, {}, [](const ReplayGap& gap) { return gap.rmse() / gap.noise_sigma; });
  return static_cast<int>(widest - gaps.begin());
}

}  // namespace musclesim
