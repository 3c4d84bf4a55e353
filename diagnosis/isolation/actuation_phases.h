/// The residual by actuation phase: while commands rise, fall or rest.
#pragma once

#include <array>
#include <string>

#include "../fit/comparison.h"

namespace musclesim {

enum class ActuationPhase { filling, venting, holding };
constexpr std::size_t phase_count = 3;
std::string nameOf(ActuationPhase phase);

/// Per phase the sum of squares of residual over sigma and the number of rows: filling while some command rises, venting while it falls,
/// holding while no command has changed for a tenth of a second. If several commands change, the one that changes most decides.
struct PhaseSums {
  std::array<double, phase_count> square{}, rows{};
  double meanSquare(ActuationPhase phase) const;
};
PhaseSums phaseSums(const Comparison& comparison, const Eigen::VectorXd& residual);

/// The actuation phase in which the residual is largest, in words; empty if it is similar in all.
std::string phaseOf(const Comparison& comparison, const Eigen::VectorXd& residual);

}  // namespace musclesim
