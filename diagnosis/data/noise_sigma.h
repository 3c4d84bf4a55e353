/// Noise of the measured signals: how much two recordings of the same motion differ.
#pragma once

#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim {

/// Standard deviation of one signal's noise, the same for all recordings of a plant, in the signal's unit. The first available of:
///   repeats      RMS difference of recordings under identical commands / sqrt(2), or of a recording and the one that its sidecar names in
///                repeat_of, interpolated to the other's times (interpolation reduces noise; the difference is scaled up for it)
///   sidecar      noise_std
///   quiet rows   1.4826 median |d - median d| / sqrt(6) of the second differences d over the quieter half of the rows. Where the same of
///                fourth differences, with sqrt(70), is less than half of that, the second ones are motion, and the fourth ones count. If
///                most rows repeat the value before (a sensor that is read less often than it is logged), only rows count that differ
///                from it
///   range        a thousandth of the range of all values: for fewer than 21 readings per recording, or readings without noise (quiet rows
///                give less than 1e-5 of the range, finer than a converter of 16 bits: the recording of a simulation)
/// but never less than the step of the lattice on which the values lie / sqrt(12). Never the residual of a fit.
struct NoiseSigma {
  double value = 0;
  enum class Source { repeats, sidecar, quiet_rows, range } source = Source::quiet_rows;
  /// Whether neither repeats nor a sidecar give it.
  bool isEstimated() const { return source == Source::quiet_rows || source == Source::range; }
};

/// RMS over sigma from which on a residual counts as a gap, where sigma is known and where it is estimated.
inline constexpr double out_of_noise = 1.15, out_of_estimated_noise = 1.3;

NoiseSigma noiseSigma(const std::vector<Recording>& recordings, const std::string& signal_name);

/// The smallest step between different values if all steps are multiples of it; 0 if the values lie on no lattice or take fewer than eight
/// levels.
double latticeStep(const std::vector<double>& values);

}  // namespace musclesim
