/// The odds of a fitted hypothesis: its misfit and its prior.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "comparison.h"
#include "hypothesis.h"

namespace musclesim {

/// A set of hypotheses (one or several effects) with fitted strengths.
struct FittedHypothesis {
  std::vector<std::size_t> members;
  Eigen::VectorXd z;  ///< coordinates of all members, one after the other
  Eigen::VectorXd half_width;
  Eigen::VectorXd residual;  ///< on the fitted segments
  double log_misfit = 0;     ///< per affected residual block
  double probability = 0;
  Eigen::VectorXd tuning = {};             ///< coordinates of the tuned parameters of the model, fitted together with the effects
  Eigen::VectorXd tuning_half_width = {};  ///< see Plant::tunedAt
  bool fitted_to_all = false;              ///< not only to the screening segments
  bool is_inactive = false;                ///< one of its effects is inactive: the fit is as good at nearly zero strength
  Eigen::VectorXd cross_validated = {};    ///< residual of each segment predicted from a fit to the others; empty if not computed
  /// The residual that its odds are computed from.
  const Eigen::VectorXd& validationResidual() const { return cross_validated.size() ? cross_validated : residual; }
};

/// Weights of the odds; docs/developer/diagnosis.md says on which cases they were found.
struct Weighing {
  double per_misfit = 24;        ///< ln odds per unit of log misfit per affected block, beyond the misfit that a law unlike ours leaves
  double per_closer_misfit = 3;  ///< the same beyond the misfit that a law close to ours leaves
  double per_parameter = 1.875;  ///< penalty of a further parameter, ln odds
  double per_effect = 10.5;      ///< penalty of a further effect, ln odds
  double per_same_place = 4.5;   ///< extra penalty if it shares a component with an earlier effect: it may only correct that effect's law
  double per_excess = 2.25;      ///< penalty per e-fold by which a parameter exceeds its usual range
  double shared_sensor = 4.5;    ///< ln odds of a fault of one sensor against a fault that all sensors share
  double law_mismatch = 0.1;     ///< share of the gap that the right cause may leave if its law differs from ours
  double close_law_mismatch = 0.01;   ///< the same if its law is close to ours
  double per_share_left = 12;         ///< ln odds of "none of these" per share of the log misfit that the best hypothesis leaves
  double share_of_unknown = 0.3;      ///< remaining share at which "none of these" is as likely as the best hypothesis
  double per_further_strength = 0.6;  ///< ln odds of "none of these" per further strength of the best: flexible laws fit much
};

class Odds {
 public:
  /// `nominal_residual` is the residual of the model without effects on `comparison`. References must outlive the object.
  Odds(const Comparison& comparison, const Eigen::VectorXd& nominal_residual, const std::vector<Hypothesis>& hypotheses)
      : comparison_(comparison), nominal_residual_(nominal_residual), hypotheses_(hypotheses) {}

  /// ln of the odds of a fitted hypothesis up to a constant; minus infinity if it has an inactive effect.
  double ofHypothesis(const FittedHypothesis& fitted) const;
  /// The part of the ln odds that the misfit gives, without the prior.
  double ofMisfit(const Eigen::VectorXd& residual) const;
  /// ln odds of no effect at all.
  double ofNoEffect() const;
  /// ln odds of a cause that the catalogue does not hold, relative to the best of some fits and no effect: a fit of the right cause leaves
  /// a small share of the log misfit; a fit of another cause leaves a larger share or has many strengths. Bounded by the odds of a cause
  /// with one parameter that leaves no misfit.
  double ofNoneOfThese(const std::vector<FittedHypothesis>& fits) const;
  /// Optimistic bound: ln odds of one more effect that leaves no misfit, relative to the fit without it.
  double optimisticBound(const FittedHypothesis& fitted) const;

 private:
  double misfitBeyond(double mismatch, const Eigen::VectorXd& residual) const;
  bool actsWhereOthersDo(const FittedHypothesis& fitted, std::size_t member) const;
  double logPrior(const FittedHypothesis& fitted) const;

  const Comparison& comparison_;
  const Eigen::VectorXd& nominal_residual_;
  const std::vector<Hypothesis>& hypotheses_;
  Weighing weighing_;
};

}  // namespace musclesim
