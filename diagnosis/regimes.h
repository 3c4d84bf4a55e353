/// The residual by what the commands do.
#pragma once

#include <array>
#include <string>

#include "comparison.h"

namespace musclesim {

enum class Regime { filling, venting, holding };
constexpr std::size_t regime_count = 3;
std::string nameOf(Regime regime);

/// Mean square of residual over floor and number of rows while some command rises, while it falls, and while none has changed for a tenth
/// of a second; of several commands the one that changes most decides.
struct RegimeSums {
  std::array<double, regime_count> square{}, rows{};
  double meanSquare(Regime regime) const;
};
RegimeSums regimeSums(const Comparison& comparison, const Eigen::VectorXd& residual);

}  // namespace musclesim
