/// How far the gap shrinks on data that neither fitting nor choosing has seen, and what simpler changes of the model would have gained.
#pragma once

#include <cstdint>

#include "attribute.h"
#include "comparison.h"

namespace musclesim {

/// 100 (1 - after / before) of the normalised gaps; 0 if there is no gap before.
double gapReductionPercent(const Gap& before, const Gap& after);

/// Whether a shrink deserves belief beside those of changes without meaning: 5 points more than the better of them and than nothing, or
/// less than half of what that one leaves is left.
bool clearlyBeats(double reduction_percent, double nominal_refit_percent, double negative_control_percent);

/// Residuals with and without what was found.
struct BeforeAndAfter {
  const Comparison& comparison;
  const Eigen::VectorXd &before, &after;
};

/// The shrink on what was held out, and the interval in which that of another recording of the same plant is expected with 95 %. It holds
/// two: a bootstrap over blocks of rows of one second, 1000 draws (Kuensch 1989), and, where there are three recordings or more, Student's
/// prediction interval for one more value of ln(after / before), which has one value per recording, fitted or held out. It reaches 100 %
/// where its upper end leaves no more than noise alone may.
Estimate gapReductionInterval(const BeforeAndAfter& held_out, const BeforeAndAfter& fitted, std::uint64_t seed);

/// Residual on held_out after re-tuning the model's own numbers (Plant::nominalParameters) on `fitted`, without any effect.
Eigen::VectorXd nominalRefitResidual(const Comparison& fitted, const Comparison& held_out, const OnSimulation& on_simulation);

/// Residual on held_out after fitting a disturbance of the commands without physical meaning: a sum of `parameter_count` sines of random
/// frequency (0.1 .. 2 Hz) and phase, their amplitudes fitted.
Eigen::VectorXd negativeControlResidual(const Comparison& fitted, const Comparison& held_out, int parameter_count, std::uint64_t seed,
                                        const OnSimulation& on_simulation);

}  // namespace musclesim
