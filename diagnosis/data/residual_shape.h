/// The shape of one signal's residual, for a reader who looks for a cause outside the catalogue.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

enum class ResidualShape { none, offset, drift, shift, ripple };

struct ResidualDescription {
  ResidualShape shape = ResidualShape::none;
  /// Offset: the mean. Drift: the slope per second. Shift: by how many seconds the measured signal comes late; negative: early. Ripple: the
  /// frequency in Hz.
  double value = 0;
};

/// The simple shape that holds at least half of the residual's power, tried in this order: a constant; a straight line; a shift in time of
/// up to a second, by whole rows; a ripple, which is the power within a tenth of the strongest frequency at or above 2 Hz, where commands
/// rarely act. Rows without a number are left out. `none` also if fewer than 64 rows remain. Shifts need rows at whole multiples of one
/// step (within a tenth of it), and ripples rows without pauses, which would add frequencies of their own.
ResidualDescription describeResidual(const std::vector<double>& time_s, const std::vector<double>& measured,
                                     const std::vector<double>& simulated);

/// "mostly an offset of 0.31", "mostly a drift of -0.02 per second", "mostly a ripple of 4.6 Hz", "mostly because it comes 0.13 s late";
/// empty for none. No effect makes a signal come early, so that the words name the clocks then.
std::string wordsFor(const ResidualDescription& description);

}  // namespace musclesim
