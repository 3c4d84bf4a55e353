/// The shape of one signal's residual, for a reader who looks for a cause outside the catalogue.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

enum class ResidualShape { none, offset, drift, ripple };

struct ResidualDescription {
  ResidualShape shape = ResidualShape::none;
  double value = 0;  ///< offset: the mean; drift: the slope per second; ripple: the frequency in Hz
};

/// The simple shape that holds at least half of the residual's power, tried in this order: a constant; a straight line; a ripple, which is
/// the power within a tenth of the strongest frequency at or above 2 Hz, where commands rarely act. Rows without a number are left out.
/// `none` also if fewer than 64 rows remain or they are not evenly spaced (within a tenth of a row): pauses would add frequencies of their
/// own.
ResidualDescription describeResidual(const std::vector<double>& time_s, const std::vector<double>& measured,
                                     const std::vector<double>& simulated);

/// "mostly an offset of 0.31", "mostly a drift of -0.02 per second", "mostly a ripple of 4.6 Hz"; empty for none.
std::string wordsFor(const ResidualDescription& description);

}  // namespace musclesim
