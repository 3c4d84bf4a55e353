/// The odds of an explanation: how little it leaves, and what speaks against it beforehand.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "comparison.h"
#include "suspect.h"

namespace musclesim {

/// A set of suspects with fitted strengths.
struct Explanation {
  std::vector<std::size_t> suspects;
  Eigen::VectorXd z;  ///< coordinates of all of them, one after the other
  Eigen::VectorXd half_width;
  Eigen::VectorXd residual;  ///< on the stretches for fitting
  double log_misfit = 0;     ///< per affected cell
  double probability = 0;
  Eigen::VectorXd tuning = {};             ///< coordinates of the numbers of the model that are fitted together with the effects
  Eigen::VectorXd tuning_half_width = {};  ///< Plant::tunedAt tells the values
  bool fitted_to_all = false;              ///< not only to the first look
  bool is_hollow = false;                  ///< as good with an effect at next to no strength: that is not what acts
  Eigen::VectorXd unseen = {};  ///< residual where every stretch is predicted from a fit to the others; empty where that was not tried
  /// What the explanation is judged by.
  const Eigen::VectorXd& judged() const { return unseen.size() ? unseen : residual; }
};

/// How answers are weighed; docs/developer/diagnosis.md says on which cases the numbers were found.
struct Weighing {
  double per_misfit = 24;             ///< ln of the odds per unit of log misfit per affected cell, beyond what a law not quite ours leaves
  double per_closer_misfit = 3;       ///< the same beyond what a law close to ours leaves
  double per_parameter = 1.875;       ///< ln of the odds that a further parameter costs
  double per_effect = 10.5;           ///< ln of the odds that a further effect costs
  double per_same_place = 4.5;        ///< the same besides, where it acts on a component of an effect before it and may only mend its law
  double per_excess = 2.25;           ///< ln of the odds per e-fold by which a parameter is beyond its usual range
  double shared_sensor = 4.5;         ///< ln of the odds of one sensor's fault against one that all sensors share
  double law_mismatch = 0.1;          ///< share of the gap that the right cause may leave since its law is not quite ours
  double close_law_mismatch = 0.01;   ///< and where the law is close to ours
  double per_share_left = 12;         ///< ln of the odds of "none of these" per share of the log misfit that the best explanation leaves
  double share_of_unknown = 0.3;      ///< share left with which "none of these" is as likely as the best explanation
  double per_further_strength = 0.6;  ///< ln of the odds of "none of these" per strength beyond the first that an effect of the best
                                      ///< explanation has: a law with many resembles causes that it is not
};

class Odds {
 public:
  /// `nominal_residual` is what the model without effects leaves of `comparison`. References must outlive it.
  Odds(const Comparison& comparison, const Eigen::VectorXd& nominal_residual, const std::vector<Suspect>& suspects)
      : comparison_(comparison), nominal_residual_(nominal_residual), suspects_(suspects) {}

  /// ln of the odds of an explanation, but for a constant; of a hollow one minus infinity.
  double ofExplanation(const Explanation& explanation) const;
  /// ln of the odds by what is left, without what speaks against an explanation beforehand.
  double ofMisfit(const Eigen::VectorXd& residual) const;
  /// The same of no effect at all.
  double ofNoEffect() const;
  /// The same of a cause that the catalogue does not hold, beside the likeliest of some explanations and no effect: a cause that the
  /// catalogue holds leaves a small share of the log misfit, what only resembles the cause a larger one or has many strengths. No more than
  /// the odds of a cause with one parameter that leaves nothing.
  double ofNoneOfThese(const std::vector<Explanation>& explanations) const;
  /// ln of the odds of one more effect that would leave nothing against the explanation without it.
  double hopeBeyond(const Explanation& explanation) const;

 private:
  double misfitBeyond(double mismatch, const Eigen::VectorXd& residual) const;
  bool actsWhereOthersDo(const Explanation& explanation, std::size_t member) const;
  double beforehand(const Explanation& explanation) const;

  const Comparison& comparison_;
  const Eigen::VectorXd& nominal_residual_;
  const std::vector<Suspect>& suspects_;
  Weighing weighing_;
};

}  // namespace musclesim
