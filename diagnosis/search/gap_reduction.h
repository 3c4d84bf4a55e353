/// Gap reduction on held-out data, and what two controls gain: re-tuning the model, and a disturbance without meaning.
#pragma once

#include <cstdint>

#include "../fit/comparison.h"
#include "../fit/sensitivity.h"

namespace musclesim {

/// 100 (1 - after / before) of the normalised gaps; 0 if there is no gap before.
double gapReductionPercent(const Gap& before, const Gap& after);

/// Whether a gap reduction clearly beats a control's: it is 5 points above the control's and above 0, or leaves less than half of what the
/// control leaves.
bool clearlyBeats(double reduction_percent, double control_percent);

/// Residuals without and with the effects found.
struct BeforeAndAfter {
  const Comparison& comparison;
  const Eigen::VectorXd &before, &after;
};

/// The gap reduction on the held-out data, and the interval in which it is expected to lie with 95 % on another recording of the same
/// plant. The interval covers two others: a bootstrap over blocks of one second of rows, 1000 draws (Kuensch 1989), and, for three
/// recordings or more, Student's prediction interval for one more value of ln(after / before), which has one value per recording, fitted or
/// held out. It extends to 100 % if its upper end leaves no more gap than noise alone may.
Estimate gapReductionInterval(const BeforeAndAfter& held_out, const BeforeAndAfter& fitted, std::uint64_t seed);

/// Residuals of a control on the rows it was fitted to and on the held-out rows; empty where it diverged.
struct ControlResidual {
  Eigen::VectorXd fitted, held_out;
};

/// Nominal refit: fits the plant's nominalParameters(), without any effect or prior.
ControlResidual nominalRefit(const Comparison& fitted, const Comparison& held_out, const OnSimulation& on_simulation);

/// Negative control: residual on held_out after fitting a disturbance of the commands without physical meaning: a sum of `parameter_count`
/// sines of random frequency (0.1 .. 2 Hz) and phase, their amplitudes fitted.
Eigen::VectorXd negativeControlResidual(const Comparison& fitted, const Comparison& held_out, int parameter_count, std::uint64_t seed,
                                        const OnSimulation& on_simulation);

}  // namespace musclesim
