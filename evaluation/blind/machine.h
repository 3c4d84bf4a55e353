/// Causes that real machines have together, with sizes that were measured on them.
#pragma once

#include <vector>

#include "cause.h"

namespace musclesim::blind {

/// The largest number of causes that one machine can have.
constexpr int most_machine_causes = 5;

/// Draws `count` of: dead time 44 to 96 ms; lag 50 to 126 ms, filling and venting apart, or in its place a rate limit around +7 and -2.7
/// bar/s at 6 bar; hysteresis of 5 to 17 %; creep of 7 to 25 % within 0.5 to 1 s; a pressure zero around -0.3 of 6 bar. Each acts on all
/// muscles by a law that the catalogue does not have. Sources of the
/// sizes: docs/reference/effects.md and docs/research/case_studies.md.
std::vector<Cause> drawMachine(int count, const Robot& robot, RandomStream& random);

/// The same cause with other sizes.
Cause drawnAgain(const Cause& cause, RandomStream& random);

}  // namespace musclesim::blind
