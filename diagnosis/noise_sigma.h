/// How much two recordings of one and the same motion would differ.
#pragma once

#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim {

/// Standard deviation of one signal's noise, the same for all recordings of a plant, in the signal's unit. The first that there is of:
///   repeats      RMS difference of recordings under identical commands / sqrt(2), or of one and what its sidecar calls its repeat_of,
///                interpolated to the other's times (which takes noise away; the difference is scaled up for it)
///   sidecar      noise_std
///   quiet rows   1.4826 median |d - median d| / sqrt(6) of the second differences d over the quieter half of the rows; of those
///                that differ from the row before, where most repeat its value (a sensor that is read less often than it is logged)
///   range        a thousandth of the range of all values: what can be told of fewer than 21 readings per recording, or without noise
/// and never less than the step of the lattice on which the values lie / sqrt(12). Never the residual of a fit.
struct NoiseSigma {
  double value = 0;
  enum class Source { repeats, sidecar, quiet_rows, range } source = Source::quiet_rows;
  /// Neither repeats nor a sidecar tell it.
  bool isEstimated() const { return source == Source::quiet_rows || source == Source::range; }
};

/// RMS over sigma from which on a residual counts as a gap, where sigma is known and where it is estimated.
inline constexpr double out_of_noise = 1.15, out_of_estimated_noise = 1.3;

NoiseSigma noiseSigma(const std::vector<Recording>& recordings, const std::string& signal_name);

/// The smallest step between different values, if all steps are multiples of it; 0 if the values lie on no lattice or are fewer than eight.
double latticeStep(const std::vector<double>& values);

}  // namespace musclesim
