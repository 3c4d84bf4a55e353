/// Rates with intervals, medians, calibration.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

namespace musclesim::blind {

/// A rate and its 95 % interval after Wilson: (p + z^2 / 2n +- z sqrt(p (1 - p) / n + z^2 / 4n^2)) / (1 + z^2 / n), z = 1.959964.
/// Source: E. B. Wilson, J. Am. Stat. Assoc. 22, 209 (1927).
struct Rate {
  int hits = 0, count = 0;
  void add(bool hit) {
    hits += hit ? 1 : 0;
    ++count;
  }
  double value() const { return count ? static_cast<double>(hits) / count : 0; }
  double low() const { return bound(-1); }
  double high() const { return bound(1); }

 private:
  double bound(double side) const;
};

/// {"hits", "count", "value", "low", "high"}.
nlohmann::json rateJson(const Rate& rate);

/// Nothing of an empty list.
std::optional<double> meanOf(const std::vector<double>& values);
std::optional<double> medianOf(std::vector<double> values);

/// An answer's confidence and whether it was right.
struct Claim {
  double probability = 0;
  bool right = false;
};

/// The claims with a probability in one tenth of 0..1.
struct CalibrationBin {
  double mean_probability = 0;
  Rate right;
};
/// Ten bins; those without claims have count 0.
std::vector<CalibrationBin> calibrationBins(const std::vector<Claim>& claims);
/// Mean over claims of the distance between their bin's mean probability and its share of right answers; nothing without claims.
std::optional<double> calibrationError(const std::vector<Claim>& claims);

/// The error that as many claims with these probabilities would have if every one of them were right with just its probability: few claims
/// have one by chance alone. Mean and 95 % quantile of 10 000 draws with a fixed seed.
struct ChanceError {
  double mean = 0, high = 0;
};
std::optional<ChanceError> calibrationErrorByChance(std::vector<Claim> claims);

}  // namespace musclesim::blind
