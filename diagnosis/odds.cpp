#include "odds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace musclesim {

/// Mean over affected blocks of ln(RMS / s), at least 0 each, with s^2 = sigma^2 + (mismatch RMS gap)^2.
double Odds::misfitBeyond(double mismatch, const Eigen::VectorXd& residual) const {
  double sum = 0;
  for (const Comparison::Block& block : comparison_.blocks()) {
    const double gap_square = comparison_.meanSquare(block, nominal_residual_);
    const double sigma_square = block.sigma * block.sigma + mismatch * mismatch * gap_square;
    sum += 0.5 * std::log(std::max(1.0, comparison_.meanSquare(block, residual) / sigma_square));
  }
  return sum / comparison_.affectedBlocks(nominal_residual_);
}

double Odds::ofMisfit(const Eigen::VectorXd& residual) const {
  return -weighing_.per_misfit * misfitBeyond(weighing_.law_mismatch, residual) -
         weighing_.per_closer_misfit * misfitBeyond(weighing_.close_law_mismatch, residual);
}

/// Whether an effect shares its place with an earlier one: the same muscle, the same signal, or both the body.
bool Odds::actsWhereOthersDo(const FittedHypothesis& fitted, std::size_t member) const {
  enum class Part { muscle, body, sensor };
  auto place = [&](std::size_t i) -> std::pair<Part, std::string> {
    const Hypothesis& hypothesis = hypotheses_[fitted.members[i]];
    switch (hypothesis.info().acts_on.front()) {
      case ComponentKind::signal:
        return {Part::sensor, hypothesis.component()};
      case ComponentKind::joint:
      case ComponentKind::hand:
      case ComponentKind::base:
        return {Part::body, "all"};
      default:
        return {Part::muscle, hypothesis.component()};
    }
  };
  auto overlap = [](const std::string& one, const std::string& other) {
    if (one == "all" || other == "all") return true;
    // A pair of muscles, "muscle_0+muscle_1", overlaps with either.
    return ("+" + one + "+").find("+" + other + "+") != std::string::npos || ("+" + other + "+").find("+" + one + "+") != std::string::npos;
  };
  const auto [part, component] = place(member);
  for (std::size_t i = 0; i < member; ++i) {
    const auto [other_part, other_component] = place(i);
    if (part == other_part && overlap(component, other_component)) return true;
  }
  return false;
}

/// Log prior of a fitted hypothesis.
double Odds::logPrior(const FittedHypothesis& fitted) const {
  double odds = -weighing_.per_parameter * static_cast<double>(fitted.z.size()) -
                weighing_.per_effect * (static_cast<double>(fitted.members.size()) - 1);
  for (std::size_t i = 1; i < fitted.members.size(); ++i)
    if (actsWhereOthersDo(fitted, i)) odds -= weighing_.per_same_place;
  Eigen::Index first = 0;
  for (const std::size_t index : fitted.members) {
    const Hypothesis& hypothesis = hypotheses_[index];
    odds -= weighing_.per_excess * hypothesis.excess(fitted.z.segment(first, hypothesis.coordinateCount()));
    if (hypothesis.info().stage == Stage::sensor && hypothesis.component() == "all") odds -= weighing_.shared_sensor;
    first += hypothesis.coordinateCount();
  }
  return odds;
}

double Odds::ofHypothesis(const FittedHypothesis& fitted) const {
  if (fitted.is_inactive) return -std::numeric_limits<double>::infinity();
  return logPrior(fitted) + ofMisfit(fitted.validationResidual());
}

double Odds::ofNoEffect() const {
  return ofMisfit(nominal_residual_);
}

double Odds::ofNoneOfThese(const std::vector<FittedHypothesis>& fits) const {
  double best = ofNoEffect(), share_left = 1, further_strengths = 0;
  const double gap = misfitBeyond(weighing_.law_mismatch, nominal_residual_);
  for (const FittedHypothesis& fitted : fits)
    if (const double odds = ofHypothesis(fitted); odds > best) {
      best = odds;
      share_left = gap > 0 ? misfitBeyond(weighing_.law_mismatch, fitted.validationResidual()) / gap : 1;
      further_strengths = 0;
      for (const std::size_t index : fitted.members)
        further_strengths += std::max(0.0, static_cast<double>(hypotheses_[index].strengths().size()) - 1);
    }
  const double of_unknown =
      best + weighing_.per_share_left * (share_left - weighing_.share_of_unknown) + weighing_.per_further_strength * further_strengths;
  return std::min(of_unknown, -weighing_.per_parameter);
}

double Odds::optimisticBound(const FittedHypothesis& fitted) const {
  return -ofMisfit(fitted.validationResidual()) - weighing_.per_effect - weighing_.per_parameter;
}

}  // namespace musclesim
