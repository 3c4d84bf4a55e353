/// Sensitivity of the predictions to every hypothesis: how much of the residual could it remove?
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "comparison.h"
#include "hypothesis.h"

namespace musclesim {

inline constexpr double largest_amount = 5;  ///< typical strengths up to which a response is taken as linear

/// The change that one hypothesis makes in the predictions, and how much of the residual a multiple of it removes.
struct Sensitivity {
  /// Change of the prediction by each strength alone, at z = 1; null if it was not simulated, or the model diverged.
  std::vector<SharedVector> per_strength;
  Eigen::VectorXd amount;       ///< multiple of each strength that removes most
  bool from_threshold = false;  ///< z = 1 was set at the threshold of the effect, below which it may do nothing
  double misfit = 0;            ///< of the residual that is left, in nats (Comparison::misfit)
  /// Largest RMS over sigma of the change at typical strengths in any block of readings; empty if not all of them could be simulated.
  std::optional<double> excitation_ratio;
};

/// Called once for every prediction that is asked for, from any thread; must be thread-safe.
using OnSimulation = std::function<void()>;

/// Simulates every hypothesis once or a few times on the comparison's segments; sensor effects of one id on different signals share a
/// simulation. `nominal` is the prediction of `base`, the model to which the hypotheses are added. It also
/// - drops strengths with a negligible influence compared with another one of the hypothesis (a force across the plane in which an elbow
///   moves), and strengths that act like another one of the hypothesis,
/// - weakens strengths that change a signal by much more than the residual, because their response need not be proportional, and those with
///   which the model diverges,
/// - simulates times, and sole strengths that seem useless, at three times their typical value, too,
/// - strengthens a sole strength that shows no response (a dead band below all commands),
/// - linearises a sole strength again if its optimum lies at the limit of the linear range.
std::vector<Sensitivity> sensitivitiesOf(const Comparison& comparison, std::vector<Hypothesis>& hypotheses, const Eigen::VectorXd& nominal,
                                         const Model& base, int job_count, const OnSimulation& on_simulation);

/// The changes by every strength alone at z = 1 beside `base`, no more.
std::vector<Sensitivity> changesOf(const Comparison& comparison, const std::vector<Hypothesis>& hypotheses, const Eigen::VectorXd& nominal,
                                   const Model& base, int job_count, const OnSimulation& on_simulation);

/// Largest RMS over sigma of a change in any block of readings (no averages, no parity).
double excitationRatio(const Comparison& comparison, const Eigen::VectorXd& change);

/// Fits the amounts of a sensitivity to a residual by least squares, reweighted three times; amounts of unsigned strengths are not
/// negative. Sets amount and misfit.
void fitLinearly(const Comparison& comparison, const Hypothesis& hypothesis, const Eigen::VectorXd& residual, Sensitivity& sensitivity);

/// Where a fit begins: at these amounts of the strengths, at the threshold if that is what the sensitivity was taken at; a vanishing
/// strength would have no derivative by its shape.
Eigen::VectorXd startOf(const Hypothesis& hypothesis, const Sensitivity& sensitivity, const std::vector<double>& amounts);

}  // namespace musclesim
