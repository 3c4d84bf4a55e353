/// Which effects explain the gap: screen, refit, compare, pairs, honest no.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "comparison.h"
#include "contender.h"
#include "odds.h"
#include "refit.h"
#include "screen.h"
#include "suspect.h"

namespace musclesim {

struct Attribution {
  std::vector<Suspect> suspects;          ///< of the whole catalogue: where the gap lies does not depend on what may be an answer
  std::vector<char> allowed;              ///< of every suspect: it may be an answer
  std::set<std::string> thinned;          ///< labels of which not all variants are among the suspects
  std::vector<Signature> signatures;      ///< of all suspects, on the first look; without changes where that was not worth its time
  std::size_t looked_at_count = 0;        ///< suspects that were looked at on all of the look
  std::vector<Explanation> explanations;  ///< best first
  double none_of_these = 0, no_effect = 0;
};

/// How far behind the best, in log misfit per affected cell, a fit may be and go on: the more the best itself still leaves, the farther,
/// since the others have as little settled after the same number of rounds.
struct Distance {
  double beyond_best, share_of_best;
};
struct Reach {
  Distance on_look, on_all;
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
  /// What planning an experiment needs to know of an explanation.
  Contender contender(const Explanation& explanation, const std::string& label) const;

 private:
  /// An explanation that is yet to be fitted.
  struct Candidate {
    Explanation explanation;
    double without;  ///< misfit on the look without its last suspect
  };

  std::vector<Candidate> begunBySquares(const std::vector<Candidate>& candidates);
  void keepBetterOfSame(std::vector<Candidate>& candidates) const;
  std::vector<std::size_t> withSecondVariants(const std::vector<std::size_t>& chosen) const;
  Eigen::VectorXd clampedAll(const std::vector<std::size_t>& members, const Eigen::VectorXd& z) const;
  FitProblem problemOf(const Explanation& explanation, const Comparison& comparison, Fidelity fidelity) const;
  void refit(Explanation& explanation, const Comparison& comparison, int rounds, Fidelity fidelity) const;
  static constexpr int more_rounds = 6;  ///< of a fit that is worth going on with
  void fitToAll(Explanation& explanation) const;
  void takeFromCounterparts(Explanation& explanation) const;
  bool isHollow(const Explanation& explanation) const;
  Comparison firstOfLook() const;
  void keepNearestVariants();
  enum class Ties { kept, dropped };  ///< of the last one kept
  void keepNearestVariants(const Comparison& comparison, std::size_t kept, Ties ties);
  std::vector<std::size_t> worthLookingAt() const;
  void lookAtSuspects(const Eigen::VectorXd& nominal);
  void lookForExcitation(const std::vector<Suspect>& typical);
  void weakenStart(Candidate& candidate) const;
  bool gainsOnLook(const Candidate& candidate) const;
  bool mayBeBelieved(const Explanation& explanation) const;
  void fitTogether(std::vector<Candidate> candidates, Reach reach);
  std::vector<std::size_t> survivors(const std::vector<double>& log_misfit, std::size_t count, bool from_every_stage) const;
  Eigen::VectorXd startOf(std::size_t index, const Signature& signature) const;
  void fitSingles();
  void fitAlone(const std::vector<std::size_t>& chosen);
  void fitMoreOnTheBestComponent();
  bool fitFurther(std::size_t count);
  bool sameEffects(const Explanation& one, const Explanation& other) const;
  std::vector<Candidate> candidatesBeside(const Explanation& base, std::size_t most) const;
  Odds odds() const { return {fit_, nominal_residual_, result_.suspects}; }
  void weigh();
  void crossCheck();
  Eigen::VectorXd stepWithout(const std::set<std::size_t>& left_out, const Explanation& explanation, const Eigen::MatrixXd& jacobian) const;
  std::set<std::size_t> sameCommandsAs(std::size_t stretch) const;
  struct Unmoved {
    std::vector<double> misfit;          ///< per stretch
    std::vector<Eigen::VectorXd> shift;  ///< fine minus coarse prediction
  };
  Eigen::VectorXd partOf(std::size_t stretch, const Eigen::VectorXd& all) const;
  Unmoved unmoved(const Explanation& explanation) const;
  Explanation movedWithout(const std::set<std::size_t>& left_out, const Explanation& explanation, Eigen::VectorXd step,
                           const Unmoved& unmoved) const;
  void predictFromOthers(Explanation& explanation) const;

  const Plant& plant_;
  const DiagnosisOptions& options_;
  OnSimulation on_simulation_;
  Comparison look_, fit_;
  std::vector<Comparison> one_by_one_;  ///< the stretches of fit_, each by itself
  Eigen::VectorXd look_residual_, nominal_residual_;
  Attribution result_;
};

}  // namespace musclesim
