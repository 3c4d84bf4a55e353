/// The equation of Comparison::misfit, written once more for tests.
#pragma once

#include <cmath>

#include "diagnosis/fit/comparison.h"

namespace musclesim {

/// Misfit of one residual block of power 1; the RMS of its residual and of the gap in noise sigmas.
inline double temperedMisfit(double rms, double gap = 0) {
  double sum = 0;
  for (const Tolerance& tolerance : tolerances) {
    const double scale_square = 1 + std::pow(tolerance.share_of_gap * gap, 2);
    sum += tolerance.nats / 2 * (std::log(scale_square + rms * rms) - std::log(scale_square + 1));
  }
  return sum;
}

/// Nats per e-fold of a residual far beyond all that is tolerated, in a block of power 1.
inline double natsPerFold() {
  double sum = 0;
  for (const Tolerance& tolerance : tolerances) sum += tolerance.nats;
  return sum;
}

}  // namespace musclesim
