/// Which sets of effects explain the gap: a search over sets that adds, swaps and drops effects, and the probabilities of what it finds.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "../fit/comparison.h"
#include "../fit/linear_model.h"
#include "../fit/rival.h"
#include "../fit/sensitivity.h"
#include "evidence.h"
#include "explanation.h"

namespace musclesim {

/// The catalogue's hypotheses on this plant with their sensitivities on the screening segments.
struct ScreenedCatalogue {
  std::vector<char> allowed;               ///< per hypothesis: it may be an answer
  std::set<std::string> thinned;           ///< labels of hypotheses that lost some of their variants
  std::vector<Sensitivity> sensitivities;  ///< per hypothesis; without changes if it was not screened on all segments
  std::size_t screened_count = 0;          ///< hypotheses that were screened on all screening segments
};

/// Screens all hypotheses, searches sets of them, and weighs the sets that are fitted to all recordings. Call screen(), then decide().
class Search {
 public:
  Search(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation);

  /// The sensitivity of the prediction to every effect of the catalogue.
  void screen();
  /// Searches, fits what is likely to all recordings, and computes the probabilities.
  void decide();

  const Comparison& screeningComparison() const { return screening_; }
  const Comparison& fitComparison() const { return fit_; }
  const Eigen::VectorXd& nominalResidual() const { return nominal_residual_; }
  const Eigen::VectorXd& screeningResidual() const { return screening_residual_; }
  const std::vector<Hypothesis>& hypotheses() const { return causes_.hypotheses; }
  const ScreenedCatalogue& catalogue() const { return catalogue_; }
  const Causes& causes() const { return causes_; }
  /// Fitted to all recordings. The chosen one is first, the others follow by probability.
  const std::vector<Explanation>& explanations() const { return explanations_; }
  /// The most probable one; there must be one.
  const Explanation& likeliest() const { return *std::ranges::max_element(explanations_, {}, &Explanation::probability); }
  /// Probability that something acts beside what the explanations hold (Evidence::ofSomethingElse).
  double somethingElse() const { return something_else_; }
  /// Single effects as fitted to the screening segments.
  std::vector<Explanation> singles() const;
  /// No effect, but the numbers of the model fitted.
  const Explanation& nothing() const { return nothing_; }
  Evidence evidence() const { return {fit_, nominal_residual_, causes_}; }
  Model modelOf(const Explanation& explanation) const { return causes_.modelOf(explanation); }
  /// The explanation as nextExperiment() needs it, with the derivatives of its prediction.
  Rival rival(const Explanation& explanation, const std::string& label) const;

 private:
  /// Error of promises in nats: the largest amount by which two successive promises of a fit were both too pessimistic, among 51 fits on
  /// two plants that ended above the best set or less than 4 nats behind it.
  static constexpr double promise_error = 6;
  static constexpr std::size_t varied_count = 5;   ///< explanations of which other variants are tried,
  static constexpr double near_best = 4;           ///< if they are not so many nats behind the best
  static constexpr double worth_polishing = 2;     ///< nats that fine steps may give a variant
  static constexpr double noticeable_loss = 0.45;  ///< nats: with less, another fit does as well
  static constexpr double hopeless = 4;            ///< nats behind the best: such sets are not extended, nor their members replaced
  static constexpr std::size_t wide_count = 4;  ///< sets of one size of which widened and exchanged forms are fitted, and so many of each

  /// A set whose fit has not begun, and the linear estimate of what it will cost.
  struct Proposal {
    Explanation start;
    double cost;                           ///< in nats, price included
    std::vector<SharedVector> known = {};  ///< FitProblem::known_derivatives
    Explanation origin = {};               ///< where the linear estimate was made: of the same members, those added without strength
  };
  /// Which hypotheses are simulated beside an explanation.
  struct Neighbours {
    std::size_t count;                                      ///< labels at most, besides some of each stage
    int variants;                                           ///< of each label
    const std::vector<Sensitivity>* beside_near = nullptr;  ///< known changes beside an explanation that is near, where there are any
    std::vector<std::string> places = {};                   ///< Hypothesis::place() of which all are simulated, whatever they promise
  };
  /// A linear model about one explanation, and the meaning of its columns.
  struct Surroundings {
    Explanation base;
    std::optional<LinearModel> model;
    std::vector<std::vector<std::size_t>> of_hypothesis;  ///< columns of each hypothesis' strengths; empty: it cannot be added
    std::vector<std::vector<std::size_t>> of_member;      ///< columns of each member's coordinates
    std::vector<std::size_t> removal_of_member, of_numbers;
    std::vector<SharedVector> derivatives;  ///< by the base's coordinates and the numbers
    std::vector<Sensitivity> sensitivities;
  };

  // screening.cpp
  Comparison firstScreeningSegment() const;
  void keepNearestVariants();
  enum class Ties { kept, dropped };  ///< variants as good as the last one kept
  void keepNearestVariants(const Comparison& comparison, std::size_t kept, Ties ties);
  std::vector<std::size_t> worthScreening() const;
  void screenHypotheses(const Eigen::VectorXd& nominal);
  void checkExcitation(const std::vector<Hypothesis>& typical);

  // surroundings.cpp
  Surroundings completed(Surroundings around, std::vector<LinearModel::Column> columns, std::vector<Sensitivity> sensitivities) const;
  Surroundings surroundingsOf(const Explanation& base, const Neighbours& neighbours) const;
  Surroundings surroundingsOf(const Explanation& base, std::vector<Sensitivity> sensitivities) const;
  std::vector<std::size_t> screenedBeside(const Explanation& base) const;
  std::vector<Surroundings> surroundingsOfNothing() const;
  const Surroundings& aboutNothingNear(const Explanation& base) const;
  void addOwnColumns(Surroundings& around, std::vector<LinearModel::Column>& columns) const;
  void addOtherColumns(Surroundings& around, std::vector<LinearModel::Column>& columns) const;
  std::vector<std::vector<std::size_t>> twins(const Surroundings& around) const;
  std::vector<double> costsOfAddingWithTwin(const Surroundings& around) const;
  std::vector<double> costsOfAdding(const Surroundings& around) const;
  static std::vector<std::size_t> inOrderOf(const std::vector<double>& costs);
  std::vector<std::size_t> worthSimulatingBeside(const Surroundings& around, const std::vector<LinearModel::Column>& columns,
                                                 const Neighbours& neighbours) const;
  std::vector<std::size_t> unscreenedBeside(const Explanation& base, const std::vector<std::string>& places) const;
  std::vector<Sensitivity> changesBeside(const Explanation& base, const std::vector<std::size_t>& indices) const;
  Proposal proposed(const Surroundings& around, const std::vector<std::size_t>& added, std::optional<std::size_t> removed = {}) const;
  std::vector<Proposal> proposedEach(const Surroundings& around, const std::vector<std::vector<std::size_t>>& added) const;

  /// The explanation by the same effects on the same components, in any variant, among others; their end if there is none.
  auto sameAmong(auto& others, const Explanation& one) const {
    const std::set<std::string> labels = causes_.labelsOf(one.members);
    return std::ranges::find_if(others, [&](const Explanation& other) { return causes_.labelsOf(other.members) == labels; });
  }

  // search.cpp
  bool isKnown(const Proposal& proposal) const;
  bool fitsBeside(std::size_t hypothesis, const std::vector<std::size_t>& members) const;
  std::vector<Proposal> nearest(std::vector<Proposal> proposals, std::size_t count, int most_variants = 1) const;
  std::vector<Proposal> nearestOfStages(const std::vector<Proposal>& all, std::size_t count, std::size_t per_stage,
                                        int most_variants) const;
  std::vector<Proposal> singleEffects(const Surroundings& around) const;
  std::vector<Proposal> largerSets(const Surroundings& around) const;
  std::vector<Proposal> additions(const Surroundings& around) const;
  std::vector<Proposal> drops(const Surroundings& around) const;
  void fitOnScreening(std::vector<Proposal> proposals);
  void nearToOrigin(Proposal& proposal) const;
  void expand(const Explanation& base);
  std::vector<std::size_t> bestOnScreening(std::size_t member_count, std::size_t count) const;
  std::vector<std::size_t> unlikeOnScreening(std::size_t member_count, std::size_t count) const;
  void extendBySize();
  bool changesFocus(std::size_t hypothesis) const;
  std::vector<Explanation> explainPressures();
  Causes::Part nearestTo(const ActiveEffect& effect) const;
  Explanation earlierFinding() const;
  Evidence screeningEvidence() const { return {screening_, screening_residual_, causes_}; }

  // stand_ins.cpp
  std::vector<Proposal> pairs(const Surroundings& around) const;
  std::vector<Proposal> widened(const Explanation& base) const;
  std::vector<Proposal> exchanged(const Explanation& base) const;
  std::vector<Proposal> standIns(const Explanation& base, std::size_t member, const std::vector<Sensitivity>& beside_all);
  std::vector<Proposal> allStandIns(const Explanation& base, std::size_t member, const std::vector<Sensitivity>& beside_all);
  std::vector<std::string> placesLike(std::size_t hypothesis) const;
  bool predictResidual(Explanation& explanation) const;
  std::vector<Proposal> additionsAt(const std::vector<std::string>& places, const Surroundings& around, std::size_t count_per_place) const;
  std::vector<Proposal> bestAdded(const Surroundings& around) const;
  void tryStandIns();

  // mechanisms.cpp
  std::vector<Explanation> alongFurtherMechanisms(const Explanation& explanation) const;
  void tryFurtherMechanisms();
  std::shared_ptr<const Explanation> withFurtherMechanisms(const Explanation& explanation) const;

  // finalists.cpp
  void fitFinalists();
  bool isDominated(const Explanation& explanation) const;
  void fitAll(std::vector<Explanation>& explanations, const std::function<void(Explanation&)>& fit) const;
  void dropHopeless();
  void fitRoughly(Explanation& explanation, double least_score = -std::numeric_limits<double>::infinity()) const;
  void fitFinely(Explanation& explanation) const;
  std::vector<Explanation> bestStarts(std::vector<Explanation> starts, std::size_t most) const;
  void fitIfPromising(std::vector<Explanation>& explanations, double least_score) const;
  bool improveBy(Explanation& one, std::vector<Explanation> others) const;
  void goOn(Explanation& explanation, Accuracy accuracy) const;
  void takeFromCounterparts(Explanation& explanation) const;
  bool hasInactiveEffect(const Explanation& explanation) const;
  std::vector<Explanation> otherVariants(const Explanation& explanation) const;
  std::vector<Explanation> otherStrengths(const Explanation& explanation) const;
  void tryOtherStrengths();
  void tryVariants();
  void tryLikeTheBest();
  void tryExchanged();
  void tryWithoutOne();
  void tryEarlier();
  void tryEffectsOfTheBest();
  void keepIfBetter(std::vector<Explanation> ones);
  void polish();
  void weigh();
  void takeOutNothing();
  void choose();

  const Plant& plant_;
  const DiagnosisOptions& options_;
  OnSimulation on_simulation_;
  Causes causes_;
  Comparison screening_, fit_;
  Eigen::VectorXd screening_residual_, nominal_residual_;
  ScreenedCatalogue catalogue_;
  /// About no effect. The first has the numbers in force. If some of them were tuned, the second has the values that the user gave.
  std::vector<Surroundings> about_nothing_;
  std::vector<Explanation> pool_;  ///< fitted to the screening segments
  std::set<std::set<std::string>> expanded_, stood_in_;
  std::set<std::pair<std::set<std::string>, std::string>> places_tried_;  ///< beside these effects, for another one of this place
  std::vector<Explanation> explanations_;
  Explanation nothing_;
  double something_else_ = 0;
};

}  // namespace musclesim
