/// What the residual of one signal looks like, for a reader who must find a cause that no catalogue holds.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

enum class ResidualShape { none, offset, drift, ripple };

struct ResidualDescription {
  ResidualShape shape = ResidualShape::none;
  double value = 0;  ///< offset: the mean; drift: the slope per second; ripple: the frequency in Hz
};

/// The simple shape that makes half of the residual's power or more, tried in this order: a constant; a straight line; a ripple, that is
/// what lies within a tenth of the strongest frequency of 2 Hz and more, where few commands reach. Rows in which either number is missing
/// are left out. `none` also where fewer than 64 rows are left or they are not evenly spaced (a tenth of a row): gaps make frequencies of
/// their own.
ResidualDescription describeResidual(const std::vector<double>& time_s, const std::vector<double>& measured,
                                     const std::vector<double>& simulated);

/// "mostly an offset of 0.31", "mostly a drift of -0.02 per second", "mostly a ripple of 4.6 Hz"; empty for none.
std::string wordsFor(const ResidualDescription& description);

}  // namespace musclesim
