#include "loop_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "../../log/columns.h"

namespace musclesim {

namespace {

/// Pearson's coefficient at the times at which both are measured; 0 where one is constant.
double correlation(const TimedSignal& x, const TimedSignal& y) {
  double n = 0, sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  for (std::size_t i = 0, k = 0; i < x.time_s.size() && k < y.time_s.size();) {
    if (x.time_s[i] != y.time_s[k]) {
      x.time_s[i] < y.time_s[k] ? ++i : ++k;
      continue;
    }
    const double a = x.values[i++], b = y.values[k++];
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    n += 1, sx += a, sy += b;
    sxx += a * a, syy += b * b, sxy += a * b;
  }
  const double variances = (n * sxx - sx * sx) * (n * syy - sy * sy);
  return variances > 0 ? (n * sxy - sx * sy) / std::sqrt(variances) : 0;
}

/// The pressure that goes with an angle most; nothing if no pressure is measured.
std::optional<std::size_t> pressureOf(const TimedSignal& angle, const std::vector<TimedSignal>& signals) {
  std::optional<std::size_t> best;
  double strongest = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (!signals[i].name.starts_with("pressure_")) continue;
    const double strength = std::abs(correlation(signals[i], angle));
    if (best && strength <= strongest) continue;
    best = i;
    strongest = strength;
  }
  return best;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> loopPairs(const std::vector<TimedSignal>& signals) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    std::optional<std::size_t> pressure;
    if (signals[i].name.starts_with("length_")) {
      const std::string name = fmt::format("pressure_{}", parseColumnName(signals[i].name).muscle);
      const auto found = std::ranges::find_if(signals, [&](const TimedSignal& other) { return other.name == name; });
      if (found != signals.end()) pressure = static_cast<std::size_t>(found - signals.begin());
    }
    if (signals[i].name.starts_with("angle_")) pressure = pressureOf(signals[i], signals);
    if (pressure) pairs.emplace_back(*pressure, i);
  }
  return pairs;
}

}  // namespace musclesim
