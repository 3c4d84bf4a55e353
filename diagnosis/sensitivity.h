/// A first look at every suspect: how much of the residual could it remove?
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "comparison.h"
#include "hypothesis.h"

namespace musclesim {

/// What one suspect does to the predictions, and how far a multiple of that goes.
struct Sensitivity {
  /// Change of the prediction by each strength alone, at z = 1; empty columns where the model diverged.
  std::vector<Eigen::VectorXd> per_strength;
  Eigen::VectorXd amount;       ///< multiple of each that removes most
  bool from_threshold = false;  ///< the typical strength was looked for from where the effect begins to show: below, there may be nothing
  double log_misfit = 0;        ///< of what is left
  /// Largest RMS of a typical strength's change in any cell, over that cell's floor; nothing where not all of them could be simulated.
  std::optional<double> excitation_ratio;
};

/// Called after each simulation, from any thread, one at a time.
using OnSimulation = std::function<void()>;

/// Whether the first look may change what a suspect's coordinates stand for, or must take them as they are.
enum class Strengths { adapted, kept };

/// One or a few simulations per suspect on the comparison's stretches; sensor effects of one id on different signals share theirs.
/// `nominal` is the prediction of `base`, the model beside which the suspects are tried. Unless strengths are to be kept, those that hardly
/// act beside another one of their suspect are left out (a force across the plane in which an elbow moves), those that change a signal by
/// much more than what is to be explained are weakened, since what they do need not be proportional to them, and a suspect's only strength
/// is made stronger where it shows nothing (a dead band below all commands), or where more of it than a straight line tells is called for.
std::vector<Sensitivity> sensitivitiesOf(const Comparison& comparison, std::vector<Hypothesis>& hypotheses, const Eigen::VectorXd& nominal,
                                         const Model& base, Strengths strengths, int job_count, const OnSimulation& on_simulation);

/// The largest RMS of some changes in any cell, over that cell's floor.
double excitationRatio(const Comparison& comparison, const std::vector<Eigen::VectorXd>& changes);

/// The amounts of a signature that remove most of a residual, by least squares weighted anew three times. Amounts of unsigned strengths
/// stay positive. Sets amount and log_misfit.
void fitLinearly(const Comparison& comparison, const Hypothesis& hypothesis, const Eigen::VectorXd& residual, Sensitivity& sensitivity);

}  // namespace musclesim
