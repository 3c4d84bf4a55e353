#include "evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace musclesim {

namespace {

enum class Part { muscle, body, sensor };

Part partOf(const Hypothesis& hypothesis) {
  switch (hypothesis.info().acts_on.front()) {
    case ComponentKind::signal:
      return Part::sensor;
    case ComponentKind::joint:
    case ComponentKind::slide:
    case ComponentKind::hand:
    case ComponentKind::base:
      return Part::body;
    default:
      return Part::muscle;
  }
}

}  // namespace

/// Whether a member shares its place with an earlier one: the same muscle, the same signal, or both the body. Effects on all components
/// come first, so that the price does not depend on the order in which a search found them.
bool Evidence::actsWhereOthersDo(const Explanation& explanation, std::size_t member) const {
  const Hypothesis& one = causes_.hypotheses[explanation.members[member]];
  const auto rank = [](const Hypothesis& hypothesis, std::size_t position) { return std::pair{hypothesis.component() != "all", position}; };
  for (std::size_t i = 0; i < explanation.members.size(); ++i) {
    const Hypothesis& other = causes_.hypotheses[explanation.members[i]];
    const Part part = partOf(one);
    if (rank(other, i) < rank(one, member) && part == partOf(other) && (part == Part::body || overlap(one.component(), other.component())))
      return true;
  }
  return false;
}

Complexity Evidence::complexityOf(const Explanation& explanation) const {
  Complexity result;
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < explanation.members.size(); ++i) {
    const Hypothesis& hypothesis = causes_.hypotheses[explanation.members[i]];
    const int count = hypothesis.coordinateCount();
    const bool is_fitted = explanation.determined.size() == explanation.z.size();
    const double determined = is_fitted ? explanation.determined.segment(first, count).sum() : count;
    // An effect of which the data determine nothing is not for free.
    result.parameters += std::max({determined, static_cast<double>(hypothesis.countedParameters()), 1.0});
    result.effects += (i > 0 ? 1 : 0) + static_cast<double>(hypothesis.furtherMechanisms().size());
    result.same_place += (actsWhereOthersDo(explanation, i) ? 1 : 0) + static_cast<double>(hypothesis.furtherMechanisms().size());
    result.excess += hypothesis.excess(explanation.z.segment(first, count));
    result.shared_sensor += hypothesis.info().stage == Stage::sensor && hypothesis.component() == "all" ? 1 : 0;
    result.places += std::log(hypothesis.placeCount());
    first += count;
  }
  return result;
}

double probabilityOfUnknown(double share_left) {
  return 1 / (1 + std::exp(-per_share_left * (share_left - share_of_unknown)));
}

double shareOfMisfitLeft(const Comparison& comparison, const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  const double of_gap = comparison.misfit(before);
  return of_gap > 0 ? std::max(0.0, comparison.misfit(after)) / of_gap : 0;
}

std::size_t namedSet(const std::vector<std::set<std::string>>& sets, const std::vector<double>& probabilities) {
  constexpr double as_likely_absent = 0.5;
  constexpr double tie = 0.2;  // nats, about 5 to 4: where it comes from is told in docs/developer/diagnosis_choices.md
  std::map<std::string, double> of_effect;
  for (std::size_t i = 0; i < sets.size(); ++i)
    for (const std::string& effect : sets[i]) of_effect[effect] += probabilities[i];
  const auto likeliest = std::ranges::max_element(probabilities);
  std::size_t named = static_cast<std::size_t>(likeliest - probabilities.begin());
  double least_errors = 0;  // expected, beyond those of naming nothing
  for (std::size_t i = 0; i < sets.size(); ++i) {
    double errors = 0;
    for (const std::string& effect : sets[i]) errors += as_likely_absent - of_effect[effect];
    if (errors >= least_errors || probabilities[i] < std::exp(-tie) * *likeliest) continue;
    least_errors = errors;
    named = i;
  }
  return named;
}

double Evidence::price(const Explanation& explanation) const {
  const auto amounts = complexityOf(explanation).asArray(), nats = prices.asArray();
  return std::inner_product(nats.begin(), nats.end(), amounts.begin(), 0.0);
}

double Evidence::score(const Explanation& explanation) const {
  if (explanation.is_inactive || explanation.residual.size() != comparison_.size()) return -std::numeric_limits<double>::infinity();
  return -comparison_.misfit(explanation.residual) - price(explanation) - costOfNumbers(explanation.numbers);
}

double Evidence::ofSomethingElse(const std::vector<Explanation>& explanations) const {
  double sum = 0;
  for (const Explanation& explanation : explanations)
    sum += explanation.probability * probabilityOfUnknown(shareOfMisfitLeft(comparison_, nominal_residual_, explanation.residual));
  return sum;
}

}  // namespace musclesim
