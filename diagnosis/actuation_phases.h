/// The residual by what the commands do.
#pragma once

#include <array>
#include <string>

#include "comparison.h"

namespace musclesim {

enum class ActuationPhase { filling, venting, holding };
constexpr std::size_t phase_count = 3;
std::string nameOf(ActuationPhase phase);

/// Mean square of residual over floor and number of rows while some command rises, while it falls, and while none has changed for a tenth
/// of a second; of several commands the one that changes most decides.
struct PhaseSums {
  std::array<double, phase_count> square{}, rows{};
  double meanSquare(ActuationPhase phase) const;
};
PhaseSums phaseSums(const Comparison& comparison, const Eigen::VectorXd& residual);

}  // namespace musclesim
