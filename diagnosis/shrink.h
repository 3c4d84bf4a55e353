/// How far the gap shrinks on data that neither fitting nor choosing has seen, and what simpler changes of the model would have gained.
#pragma once

#include <cstdint>

#include "attribute.h"
#include "comparison.h"

namespace musclesim {

/// 100 (1 - after / before) of the normalised gaps; 0 if there is no gap before.
double shrinkPercent(const Gap& before, const Gap& after);

/// The same with its 95 % interval by a bootstrap over blocks of rows (one second), 1000 draws. Source: Kuensch 1989.
Estimate shrinkInterval(const Comparison& held_out, const Eigen::VectorXd& before, const Eigen::VectorXd& after, std::uint64_t seed);

/// Residual on held_out after re-tuning the model's own numbers (Plant::nominalParameters) on `fitted`, without any effect.
Eigen::VectorXd nominalRefitResidual(const Comparison& fitted, const Comparison& held_out, const OnSimulation& on_simulation);

/// Residual on held_out after fitting a disturbance of the commands without physical meaning: a sum of `parameter_count` sines of random
/// frequency (0.1 .. 2 Hz) and phase, their amplitudes fitted.
Eigen::VectorXd shamResidual(const Comparison& fitted, const Comparison& held_out, int parameter_count, std::uint64_t seed,
                             const OnSimulation& on_simulation);

}  // namespace musclesim
