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
  Eigen::VectorXd unseen = {};  ///< residual where every stretch is predicted from a fit to the others; empty where that was not tried
  /// What the explanation is judged by.
  const Eigen::VectorXd& judged() const { return unseen.size() ? unseen : residual; }
};

/// How answers are weighed; docs/diagnosing.md says on which cases the numbers were found.
struct Weighing {
  double per_misfit = 8;       ///< ln of the odds per unit of log misfit per affected cell
  double per_parameter = 1;    ///< ln of the odds that a further parameter costs
  double per_effect = 5;       ///< ln of the odds that a further effect costs
  double per_same_place = 6;   ///< the same besides, where it acts on a component of an effect before it and may only mend its law
  double per_own_gain = 14;    ///< ln of the odds per unit of log misfit that further effects gain where they do more than mend a law
  double mended_share = 0.5;   ///< what they gain below this share of what the best one alone changes may only mend its law
  double per_excess = 1.5;     ///< ln of the odds per e-fold by which a parameter is beyond its usual range
  double shared_sensor = 3;    ///< ln of the odds of one sensor's fault against one that all sensors share
  double law_mismatch = 0.01;  ///< share of the residual that the right cause may leave since its law is not quite ours
  double none_share = 0.6;     ///< "none of these" stands for a cause that would leave this share of the log misfit without effects
};

class Odds {
 public:
  /// `nominal_residual` is what the model without effects leaves of `comparison`. References must outlive it.
  Odds(const Comparison& comparison, const Eigen::VectorXd& nominal_residual, const std::vector<Suspect>& suspects)
      : comparison_(comparison), nominal_residual_(nominal_residual), suspects_(suspects) {}

  /// ln of the odds of an explanation, but for a constant; `alone` is that of its effects which leaves least alone.
  double ofExplanation(const Explanation& explanation, const Explanation& alone) const;
  /// The same of no effect at all, and of a cause that the catalogue does not hold.
  double ofNoEffect() const;
  double ofNoneOfThese() const;
  /// ln of the odds of one more effect that would leave nothing against the explanation without it.
  double hopeBeyond(const Explanation& explanation, const Explanation& alone) const;
  /// Mean over affected cells of ln(RMS / floor), a small share of the gap counted as noise: the right cause's law is not quite ours.
  double misfitLeftBy(const Eigen::VectorXd& residual) const;

 private:
  Eigen::VectorXd mismatchOf(double share, const Eigen::VectorXd& residual) const;
  double weighedMisfit(const Eigen::VectorXd& residual, const Eigen::VectorXd& mismatch) const;
  double ownGain(const Eigen::VectorXd& residual, const Explanation& alone) const;
  bool actsWhereOthersDo(const Explanation& explanation, std::size_t member) const;
  double ofMisfit(const Explanation& explanation, const Explanation& alone) const;
  double beforehand(const Explanation& explanation) const;

  const Comparison& comparison_;
  const Eigen::VectorXd& nominal_residual_;
  const std::vector<Suspect>& suspects_;
  Weighing weighing_;
};

}  // namespace musclesim
