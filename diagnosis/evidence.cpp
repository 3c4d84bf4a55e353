#include "evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace musclesim {

namespace {

enum class Part { muscle, body, sensor };

Part partOf(const Hypothesis& hypothesis) {
  switch (hypothesis.info().acts_on.front()) {
    case ComponentKind::signal:
      return Part::sensor;
    case ComponentKind::joint:
    case ComponentKind::hand:
    case ComponentKind::base:
      return Part::body;
    default:
      return Part::muscle;
  }
}

}  // namespace

/// Whether a member shares its place with an earlier one: the same muscle, the same signal, or both the body.
bool Evidence::actsWhereOthersDo(const Explanation& explanation, std::size_t member) const {
  const Hypothesis& one = causes_.hypotheses[explanation.members[member]];
  return std::any_of(explanation.members.begin(), explanation.members.begin() + static_cast<std::ptrdiff_t>(member), [&](std::size_t index) {
    const Hypothesis& other = causes_.hypotheses[index];
    const Part part = partOf(one);
    return part == partOf(other) && (part == Part::body || overlap(one.component(), other.component()));
  });
}

double Evidence::price(const Explanation& explanation) const {
  if (explanation.members.empty()) return 0;
  double price = weighing_.per_effect * (static_cast<double>(explanation.members.size()) - 1);
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < explanation.members.size(); ++i) {
    const Hypothesis& hypothesis = causes_.hypotheses[explanation.members[i]];
    price += weighing_.per_parameter * std::max(hypothesis.coordinateCount(), hypothesis.countedParameters());
    if (actsWhereOthersDo(explanation, i)) price += weighing_.per_same_place;
    price += weighing_.per_excess * hypothesis.excess(explanation.z.segment(first, hypothesis.coordinateCount()));
    if (hypothesis.info().stage == Stage::sensor && hypothesis.component() == "all") price += weighing_.shared_sensor;
    first += hypothesis.coordinateCount();
  }
  return price;
}

double Evidence::score(const Explanation& explanation) const {
  if (explanation.is_inactive || explanation.residual.size() != comparison_.size()) return -std::numeric_limits<double>::infinity();
  return -comparison_.misfit(explanation.validationResidual()) - price(explanation) - 0.5 * explanation.numbers.squaredNorm();
}

double Evidence::ofSomethingElse(const std::vector<Explanation>& explanations) const {
  const double gap = comparison_.misfit(nominal_residual_);
  const Explanation& best = *std::ranges::max_element(explanations, {}, &Explanation::score);
  const double share_left = gap > 0 ? std::max(0.0, comparison_.misfit(best.validationResidual())) / gap : 0;
  return weighing_.per_share_left * (share_left - weighing_.share_of_unknown);
}

}  // namespace musclesim
