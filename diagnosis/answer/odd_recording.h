/// A recording that contradicts the others.
#pragma once

#include <string>
#include <vector>

#include "verdict.h"

namespace musclesim {

/// A sentence for each recording in which a signal is left five times as far off as in every other one, and five noise floors at least:
/// something differs there, or a column means something else. `fitted` and `after` are the residuals on the fitted and on the held-out
/// rows. With fewer than three recordings nothing is said.
std::vector<std::string> oddRecordings(const Search& search, const HeldOut& held_out, const Eigen::VectorXd& fitted,
                                       const Eigen::VectorXd& after);

}  // namespace musclesim
