/// Where the gap arises: stages of a sample's way, components, regimes. Comes before, and does not use, the fits of effects.
#pragma once

#include <string>
#include <vector>

#include "comparison.h"
#include "hypothesis.h"
#include "sensitivity.h"

namespace musclesim {

struct FaultIsolation {
  std::vector<Place> places;  ///< largest share first; shares sum to 1
  std::string method;         ///< which signals decided, in words
};

/// Stages are told apart by substitution where the signals are there:
///   measured pressures as commands of the model: what vanishes was made by command or pressure stage
///   measured pressure and length into the force law, against the measured tension: force stage
/// on all that is fitted (`whole`), and, for what substitution leaves open, by how well a small typical disturbance of each stage
/// (`signatures`) resembles the residual on the first look.
FaultIsolation isolateFault(const Comparison& whole, const Eigen::VectorXd& residual_of_all, const Comparison& screening,
                            const std::vector<Hypothesis>& hypotheses, const std::vector<Sensitivity>& sensitivities,
                            const Eigen::VectorXd& screening_residual);

}  // namespace musclesim
