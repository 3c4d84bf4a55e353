#include "statistics.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "musclesim/base/random.h"

namespace musclesim::blind {

double Rate::bound(double side) const {
  constexpr double z = 1.959964;
  if (count == 0) return side < 0 ? 0 : 1;
  const double n = count, p = value();
  const double bound = (p + z * z / (2 * n) + side * z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n))) / (1 + z * z / n);
  return std::clamp(bound, 0.0, 1.0);
}

nlohmann::json rateJson(const Rate& rate) {
  return {{"hits", rate.hits}, {"count", rate.count}, {"value", rate.value()}, {"low", rate.low()}, {"high", rate.high()}};
}

std::optional<double> meanOf(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::optional<double> medianOf(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

std::vector<CalibrationBin> calibrationBins(const std::vector<Claim>& claims) {
  constexpr int bin_count = 10;
  std::vector<CalibrationBin> bins(bin_count);
  for (const Claim& claim : claims) {
    CalibrationBin& bin = bins[static_cast<std::size_t>(std::clamp(static_cast<int>(claim.probability * bin_count), 0, bin_count - 1))];
    bin.mean_probability += claim.probability;
    bin.right.add(claim.right);
  }
  for (CalibrationBin& bin : bins)
    if (bin.right.count) bin.mean_probability /= bin.right.count;
  return bins;
}

std::optional<double> calibrationError(const std::vector<Claim>& claims) {
  if (claims.empty()) return std::nullopt;
  double sum = 0;
  for (const CalibrationBin& bin : calibrationBins(claims)) sum += bin.right.count * std::abs(bin.mean_probability - bin.right.value());
  return sum / static_cast<double>(claims.size());
}

std::optional<ChanceError> calibrationErrorByChance(std::vector<Claim> claims) {
  if (claims.empty()) return std::nullopt;
  constexpr std::size_t draw_count = 10000;
  RandomStream random(1, "blind.calibration");
  std::vector<double> errors;
  for (std::size_t draw = 0; draw < draw_count; ++draw) {
    for (Claim& claim : claims) claim.right = random.uniform() < claim.probability;
    errors.push_back(*calibrationError(claims));
  }
  std::ranges::sort(errors);
  return ChanceError{*meanOf(errors), errors[draw_count * 95 / 100]};
}

}  // namespace musclesim::blind
