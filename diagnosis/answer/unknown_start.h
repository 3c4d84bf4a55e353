/// Recordings that begin in the middle of a motion.
#pragma once

#include <map>
#include <string>

#include "verdict.h"

namespace musclesim {

struct UnknownStarts {
  std::map<int, double> seconds;  ///< to leave out at the beginning, by recording
  std::string sentence;
};

/// The recordings of which nothing tells how they begin (Plant::beginsUnknown), which last at least four seconds, and in whose first second
/// a signal is left three times as far off as in the second half, absolutely and compared with how it moves there, and three noise floors
/// at least: the model begins at rest and without a history, and the machine did not. Left out are the whole seconds at the beginning in
/// which that is so, at most a third of the recording; if there is such a recording, one second of the others of which nothing
/// tells how they begin, too, unless they are shorter or move mostly then. `fitted` and `after` are the residuals on the fitted and on the
/// held-out rows.
UnknownStarts unknownStarts(const Search& search, const HeldOut& held_out, const Eigen::VectorXd& fitted, const Eigen::VectorXd& after);

}  // namespace musclesim
