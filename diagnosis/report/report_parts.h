/// The parts of report.html that have a file of their own; empty where there is nothing to show.
#pragma once

#include <string>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim::report {

/// What to believe, where, how sure, how much is left, what to do next.
std::string verdictBox(const Diagnosis& d);
std::string where(const Diagnosis& d);
std::string which(const Diagnosis& d);
/// The gap before and after: what each effect removes, controls, phases of actuation, signals.
std::string howFar(const Diagnosis& d);
/// Measured and simulated values and residuals over time.
std::string curves(const Diagnosis& d);
/// Pressure-length loops, or pressure-angle loops, where a cause in the force or body stage makes them tell more than curves over time.
std::string loops(const Diagnosis& d);

}  // namespace musclesim::report
