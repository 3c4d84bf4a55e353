/// What one signal was measured to be, what the model says instead, and which differences noise explains.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim {

/// Half the width of a noise band in standard deviations of the noise: of normal noise three rows in a thousand lie outside.
inline constexpr double band_in_sigmas = 3;

/// One signal of a recording and its simulation. The simulation may end earlier.
struct ReplayGap {
  std::string name;
  std::vector<double> time_s, measured, simulated;  ///< [row]; NaN: not measured
  double noise_sigma = 0;                           ///< standard deviation, in the signal's unit; see noiseSigma

  double band() const { return band_in_sigmas * noise_sigma; }
  /// Measured minus simulated; NaN where one of them is missing.
  double residual(std::size_t row) const;
  std::vector<double> residuals() const;
  /// RMS of the residual; 0 if nothing can be compared.
  double rmse() const;
  /// Intervals of time in which the residual lies outside of its noise band, on one side and for at least two rows that are measured:
  /// single rows leave it by chance. Each from its first row to its last.
  std::vector<std::pair<double, double>> outsideS() const;
};

/// The gaps of all signals that both recordings have, except commands and signals without readings, in the order of `simulated`.
std::vector<ReplayGap> replayGaps(const Recording& measured, const Recording& simulated);

/// Number of the gap whose RMS is the largest multiple of its noise; -1 if there are none.
int widestGap(const std::vector<ReplayGap>& gaps);

}  // namespace musclesim
