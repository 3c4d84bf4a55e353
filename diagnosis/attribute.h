/// Which effects explain the gap: screen, refit, compare, pairs, honest no.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "comparison.h"
#include "hypothesis.h"
#include "odds.h"
#include "refit.h"
#include "rival.h"
#include "sensitivity.h"

namespace musclesim {

struct Attribution {
  std::vector<Hypothesis> hypotheses;      ///< of the whole catalogue: where the gap lies does not depend on what may be an answer
  std::vector<char> allowed;               ///< of every suspect: it may be an answer
  std::set<std::string> thinned;           ///< labels of which not all variants are among the suspects
  std::vector<Sensitivity> sensitivities;  ///< of all suspects, on the first look; without changes where that was not worth its time
  std::size_t screened_count = 0;          ///< suspects that were looked at on all of the look
  std::vector<FittedHypothesis> fits;      ///< best first
  double none_of_these = 0, no_effect = 0;
};

/// How far behind the best, in log misfit per affected cell, a fit may be and go on: the more the best itself still leaves, the farther,
/// since the others have as little settled after the same number of rounds.
struct PruningMargin {
  double beyond_best, share_of_best;
};
struct PruningMargins {
  PruningMargin on_screening, on_all;
};

class Attributor {
 public:
  Attributor(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation);

  /// The first look: what every effect of the catalogue would change.
  void screen();
  /// Fits, pairs, probabilities.
  void decide();

  const Comparison& screeningComparison() const { return screening_; }
  const Comparison& fitComparison() const { return fit_; }
  const Eigen::VectorXd& nominalResidual() const { return nominal_residual_; }
  const Eigen::VectorXd& screeningResidual() const { return screening_residual_; }
  const Attribution& result() const { return result_; }
  Model modelOf(const FittedHypothesis& fitted) const;
  const FittedHypothesis& nearest() const;
  /// What planning an experiment needs to know of an explanation.
  Rival rival(const FittedHypothesis& fitted, const std::string& label) const;

 private:
  /// An explanation that is yet to be fitted.
  struct Candidate {
    FittedHypothesis fitted;
    double without;  ///< misfit on the look without its last suspect
  };

  std::vector<Candidate> begunBySquares(const std::vector<Candidate>& candidates);
  void keepBetterOfSame(std::vector<Candidate>& candidates) const;
  std::vector<std::size_t> withSecondVariants(const std::vector<std::size_t>& chosen) const;
  Eigen::VectorXd clampedAll(const std::vector<std::size_t>& members, const Eigen::VectorXd& z) const;
  FitProblem problemOf(const FittedHypothesis& fitted, const Comparison& comparison, Fidelity fidelity) const;
  void refit(FittedHypothesis& fitted, const Comparison& comparison, int rounds, Fidelity fidelity) const;
  static constexpr int more_rounds = 6;  ///< of a fit that is worth going on with
  void fitToAll(FittedHypothesis& fitted) const;
  void takeFromCounterparts(FittedHypothesis& fitted) const;
  bool hasInactiveEffect(const FittedHypothesis& fitted) const;
  Comparison firstScreeningSegment() const;
  void keepNearestVariants();
  enum class Ties { kept, dropped };  ///< of the last one kept
  void keepNearestVariants(const Comparison& comparison, std::size_t kept, Ties ties);
  std::vector<std::size_t> worthScreening() const;
  void screenHypotheses(const Eigen::VectorXd& nominal);
  void checkExcitation(const std::vector<Hypothesis>& typical);
  void weakenStart(Candidate& candidate) const;
  bool gainsOnScreening(const Candidate& candidate) const;
  bool mayBeBelieved(const FittedHypothesis& fitted) const;
  void fitTogether(std::vector<Candidate> candidates, PruningMargins reach);
  std::vector<std::size_t> survivors(const std::vector<double>& log_misfit, std::size_t count, bool from_every_stage) const;
  Eigen::VectorXd startOf(std::size_t index, const Sensitivity& sensitivity) const;
  void fitSingles();
  void fitAlone(const std::vector<std::size_t>& chosen);
  void fitMoreOnTheBestComponent();
  bool fitFurther(std::size_t count);
  bool sameEffects(const FittedHypothesis& one, const FittedHypothesis& other) const;
  std::vector<Candidate> candidatesBeside(const FittedHypothesis& base, std::size_t most) const;
  Odds odds() const { return {fit_, nominal_residual_, result_.hypotheses}; }
  void weigh();
  void crossCheck();
  Eigen::VectorXd stepWithout(const std::set<std::size_t>& left_out, const FittedHypothesis& fitted, const Eigen::MatrixXd& jacobian) const;
  std::set<std::size_t> sameCommandsAs(std::size_t segment) const;
  struct Unmoved {
    std::vector<double> misfit;          ///< per stretch
    std::vector<Eigen::VectorXd> shift;  ///< fine minus coarse prediction
  };
  Eigen::VectorXd partOf(std::size_t segment, const Eigen::VectorXd& all) const;
  Unmoved unmoved(const FittedHypothesis& fitted) const;
  FittedHypothesis movedWithout(const std::set<std::size_t>& left_out, const FittedHypothesis& fitted, Eigen::VectorXd step,
                                const Unmoved& unmoved) const;
  void predictFromOthers(FittedHypothesis& fitted) const;

  const Plant& plant_;
  const DiagnosisOptions& options_;
  OnSimulation on_simulation_;
  Comparison screening_, fit_;
  std::vector<Comparison> one_by_one_;  ///< the stretches of fit_, each by itself
  Eigen::VectorXd screening_residual_, nominal_residual_;
  Attribution result_;
};

}  // namespace musclesim
