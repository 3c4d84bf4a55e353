/// How believable fitted explanations are: misfit, price of complexity, probabilities.
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "../fit/comparison.h"
#include "explanation.h"

namespace musclesim {

/// What the price of an explanation is made of, one number each.
struct Complexity {
  double parameters = 0;  ///< directions of coordinates that the data determine, or numbers that were counted or tried
  double effects = 0;     ///< beyond the first, and further mechanisms within the law of one (further lags)
  double same_place = 0;  ///< effects on the same muscle or signal as an earlier one, or both on the body, and further mechanisms: they may
                          ///< only mend its law
  double excess = 0;      ///< e-folds by which parameters leave their usual range
  double shared_sensor = 0;  ///< faults that all sensors share
  double places = 0;         ///< ln of the number of components that an effect could act on alone: they share its prior
  constexpr std::array<double, 6> asArray() const { return {parameters, effects, same_place, excess, shared_sensor, places}; }
};
/// Nats for one of each; docs/developer/diagnosis_choices.md says on which plants they were found.
inline constexpr Complexity prices = {
    .parameters = 1.0, .effects = 3.1, .same_place = 1.0, .excess = 2.0, .shared_sensor = 4.0, .places = 1.0};
/// ln odds of something else per share of the misfit that an explanation leaves, and the share at which it is as likely as not.
inline constexpr double per_share_left = 12, share_of_unknown = 0.3;
/// Least probability of what is listed; such explanations are fitted to the end and may be chosen.
inline constexpr double least_listed = 0.01;
/// Where something else acts, the probability that a named effect only stands in for it; docs/developer/diagnosis_choices.md says where it
/// comes from.
inline constexpr double stand_in_share = 0.6;

/// What it costs, in nats, that numbers of the model are off by so many tolerances: eta^2 / 2 each, a normal prior.
inline double costOfNumbers(const Eigen::VectorXd& numbers) {
  return numbers.squaredNorm() / 2;
}

/// The probability that something else acts, 1 / (1 + exp(-per_share_left (share_left - share_of_unknown))), where an explanation leaves a
/// share of the misfit of the model without effects: the right one leaves a small one.
double probabilityOfUnknown(double share_left);

/// The share of the misfit of a residual that is left in another one.
double shareOfMisfitLeft(const Comparison& comparison, const Eigen::VectorXd& before, const Eigen::VectorXd& after);

/// Index of the set of effects that is named: the likeliest one. Among sets that tie with it, which are less likely by 0.2 nats or less,
/// the one with the largest
///     sum over its effects j of (P(j) - 1/2),   P(j) = sum of the probabilities of the sets that contain j
/// so that the fewest wrong and missing names are expected (Hamming loss; Barbieri and Berger 2004). If no set has a positive sum, the
/// likeliest is named. `sets` and `probabilities` have the same size, at least 1.
std::size_t namedSet(const std::vector<std::set<std::string>>& sets, const std::vector<double>& probabilities);

class Evidence {
 public:
  /// References must outlive the object.
  Evidence(const Comparison& comparison, const Eigen::VectorXd& nominal_residual, const Causes& causes)
      : comparison_(comparison), nominal_residual_(nominal_residual), causes_(causes) {}

  Complexity complexityOf(const Explanation& explanation) const;
  /// The complexity times the prices, in nats.
  double price(const Explanation& explanation) const;
  /// ln of the odds up to a constant: -misfit - price - sum of numbers^2 / 2; minus infinity with an inactive effect.
  double score(const Explanation& explanation) const;
  /// The largest misfit and sum of numbers^2 / 2, in nats, with which an explanation that is not fitted yet may come up to a score.
  double largestCost(const Explanation& explanation, double least_score) const { return -least_score - price(explanation); }
  /// The probability that something acts beside what the explanations hold: the sum over explanations S of P(S) times
  /// probabilityOfUnknown() of the share of the misfit that S leaves. Needs Explanation::probability, of sum 1.
  double ofSomethingElse(const std::vector<Explanation>& explanations) const;

 private:
  bool actsWhereOthersDo(const Explanation& explanation, std::size_t member) const;

  const Comparison& comparison_;
  const Eigen::VectorXd& nominal_residual_;
  const Causes& causes_;
};

}  // namespace musclesim
