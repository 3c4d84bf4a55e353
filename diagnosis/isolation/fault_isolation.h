/// Fault isolation: at which stage, component and actuation phase the gap arises. Runs before the fits of effects and does not use them.
#pragma once

#include <string>
#include <vector>

#include "../fit/comparison.h"
#include "../fit/hypothesis.h"
#include "../fit/sensitivity.h"

namespace musclesim {

struct FaultIsolation {
  std::vector<Place> places;  ///< largest share first; shares sum to 1
  std::string method;         ///< the evidence, in words
};

/// Distinguishes stages by signals of motion against each other (the sensor of the one that contradicts the others), and by substitution if
/// the signals are measured:
///   measured pressures as commands of the model: the part of the gap that vanishes arose in the command or pressure stage
///   measured pressure and length into the force law, compared with the measured tension: force stage
/// on all fitted data (`whole`). For the stages that substitution leaves open, compares the residual on the screening segments with the
/// change that a small typical disturbance of each stage makes (`sensitivities`).
FaultIsolation isolateFault(const Comparison& whole, const Eigen::VectorXd& residual_of_all, const Comparison& screening,
                            const std::vector<Hypothesis>& hypotheses, const std::vector<Sensitivity>& sensitivities);

}  // namespace musclesim
