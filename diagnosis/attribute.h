/// Which effects explain the gap: screen, refit, compare, pairs, honest no.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "comparison.h"
#include "refit.h"
#include "screen.h"
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
};

/// How answers are weighed; docs/diagnosing.md says on which cases the numbers were found.
struct Weighing {
  double per_misfit = 7;        ///< ln of the odds per unit of log misfit per affected cell
  double per_parameter = 1;     ///< ln of the odds that a further parameter costs
  double per_effect = 6.5;      ///< ln of the odds that a further effect costs
  double per_further_gain = 5;  ///< ln of the odds per unit of log misfit that further effects gain over the first
  double per_own_gain = 14;     ///< the same besides, of what they gain where they do more than mend the first one's law
  double mended_share = 0.5;    ///< what they gain below this share of what the first effect changes may only mend its law
  double per_excess = 1.5;      ///< ln of the odds per e-fold by which a parameter is beyond its usual range
  double shared_sensor = 3;     ///< ln of the odds of one sensor's fault against one that all sensors share
  double law_mismatch = 0.01;   ///< share of the residual that the right cause may leave since its law is not quite ours
  double none_share = 0.6;      ///< "none of these" stands for a cause that would leave this share of the log misfit without effects
};

struct Attribution {
  std::vector<Suspect> suspects;          ///< of the whole catalogue: where the gap lies does not depend on what may be an answer
  std::vector<char> allowed;              ///< of every suspect: it may be an answer
  std::set<std::string> thinned;          ///< labels of which not all variants are among the suspects
  std::vector<Signature> signatures;      ///< of all suspects, on the first look
  std::vector<Explanation> explanations;  ///< best first
  double none_of_these = 0, no_effect = 0;
};

/// A fit goes on while its log misfit per affected cell is within that of the best: on the look, on all recordings.
struct Reach {
  double on_look, on_all;
};

class Attributor {
 public:
  Attributor(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation);

  /// The first look: what every effect of the catalogue would change.
  void look();
  /// Fits, pairs, probabilities.
  void decide();

  const Comparison& lookComparison() const { return look_; }
  const Comparison& fitComparison() const { return fit_; }
  const Eigen::VectorXd& nominalResidual() const { return nominal_residual_; }
  const Eigen::VectorXd& lookResidual() const { return look_residual_; }
  const Attribution& result() const { return result_; }
  Model modelOf(const Explanation& explanation) const;
  const Explanation& nearest() const;

 private:
  void refit(Explanation& explanation, const Comparison& comparison, int rounds, Fidelity fidelity) const;
  void keepNearestVariants();
  void weakenStart(Explanation& candidate, double without) const;
  void fitTogether(std::vector<Explanation> candidates, double without, Reach reach);
  std::vector<std::size_t> survivors(const std::vector<double>& log_misfit, std::size_t count, bool from_every_stage) const;
  Eigen::VectorXd startOf(std::size_t index, const Signature& signature) const;
  void fitSingles();
  void fitAlone(const std::vector<std::size_t>& chosen);
  void fitMoreOnTheBestComponent();
  bool fitFurther(std::size_t count);
  Eigen::VectorXd mismatchOf(double share, const Eigen::VectorXd& residual) const;
  double weighedMisfit(const Eigen::VectorXd& residual, const Eigen::VectorXd& mismatch) const;
  double misfitLeftBy(const Eigen::VectorXd& residual) const;
  const Explanation& firstOf(const Explanation& explanation) const;
  double furtherLogOdds(const Eigen::VectorXd& residual, const Explanation& first) const;
  double misfitLogOdds(const Explanation& explanation) const;
  double priorLogOdds(const Explanation& explanation) const;
  void weigh();

  const Plant& plant_;
  const DiagnosisOptions& options_;
  OnSimulation on_simulation_;
  Comparison look_, fit_;
  Eigen::VectorXd look_residual_, nominal_residual_;
  Attribution result_;
  Weighing weighing_;
};

}  // namespace musclesim
