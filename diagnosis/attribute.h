/// Which effects explain the gap: screens all hypotheses, fits the promising ones, compares them, adds further effects, and says if none
/// fits.
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
  std::vector<Hypothesis> hypotheses;      ///< whole catalogue: fault isolation does not depend on the candidates
  std::vector<char> allowed;               ///< per hypothesis: it may be an answer
  std::set<std::string> thinned;           ///< labels of hypotheses that lost some of their variants
  std::vector<Sensitivity> sensitivities;  ///< per hypothesis, on the screening segments; without changes if it was not screened there
  std::size_t screened_count = 0;          ///< hypotheses that were screened on all screening segments
  std::vector<FittedHypothesis> fits;      ///< best first
  double none_of_these = 0, no_effect = 0;
};

/// Pruning margin in log misfit per affected residual block: a candidate continues if its misfit is within `beyond_best` plus
/// `share_of_best` times the best misfit of the best one; early fits have not converged.
struct PruningMargin {
  double beyond_best, share_of_best;
};
struct PruningMargins {
  PruningMargin on_screening, on_all;
};

class Attributor {
 public:
  Attributor(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation);

  /// Screening: the sensitivity of the residual to every effect of the catalogue.
  void screen();
  /// Fits single hypotheses, adds further effects, computes the probabilities.
  void decide();

  const Comparison& screeningComparison() const { return screening_; }
  const Comparison& fitComparison() const { return fit_; }
  const Eigen::VectorXd& nominalResidual() const { return nominal_residual_; }
  const Eigen::VectorXd& screeningResidual() const { return screening_residual_; }
  const Attribution& result() const { return result_; }
  Model modelOf(const FittedHypothesis& fitted) const;
  const FittedHypothesis& nearest() const;
  /// The fitted hypothesis as nextExperiment() needs it, with the derivatives of its prediction.
  Rival rival(const FittedHypothesis& fitted, const std::string& label) const;

 private:
  /// A hypothesis that is yet to be fitted.
  struct Candidate {
    FittedHypothesis fitted;
    double without;  ///< misfit on the screening segments without its last effect
  };

  std::vector<Candidate> begunBySquares(const std::vector<Candidate>& candidates);
  void keepBetterOfSame(std::vector<Candidate>& candidates) const;
  std::vector<std::size_t> withSecondVariants(const std::vector<std::size_t>& chosen) const;
  Eigen::VectorXd clampedAll(const std::vector<std::size_t>& members, const Eigen::VectorXd& z) const;
  FitProblem problemOf(const FittedHypothesis& fitted, const Comparison& comparison, Fidelity fidelity) const;
  void refit(FittedHypothesis& fitted, const Comparison& comparison, int rounds, Fidelity fidelity) const;
  static constexpr int more_rounds = 6;  ///< of a fit that continues after the first rounds
  void fitToAll(FittedHypothesis& fitted) const;
  void takeFromCounterparts(FittedHypothesis& fitted) const;
  bool hasInactiveEffect(const FittedHypothesis& fitted) const;
  Comparison firstScreeningSegment() const;
  void keepNearestVariants();
  enum class Ties { kept, dropped };  ///< variants as good as the last one kept
  void keepNearestVariants(const Comparison& comparison, std::size_t kept, Ties ties);
  std::vector<std::size_t> worthScreening() const;
  void screenHypotheses(const Eigen::VectorXd& nominal);
  void checkExcitation(const std::vector<Hypothesis>& typical);
  void weakenStart(Candidate& candidate) const;
  bool gainsOnScreening(const Candidate& candidate) const;
  bool isProbableEnough(const FittedHypothesis& fitted) const;
  void fitTogether(std::vector<Candidate> candidates, PruningMargins margins);
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
    std::vector<double> misfit;          ///< per segment
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
  std::vector<Comparison> one_by_one_;  ///< the segments of fit_, one comparison each
  Eigen::VectorXd screening_residual_, nominal_residual_;
  Attribution result_;
};

}  // namespace musclesim
