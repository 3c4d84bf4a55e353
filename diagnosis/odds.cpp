#include "odds.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace musclesim {

/// Mean square per cell of a share of the residual.
Eigen::VectorXd Odds::mismatchOf(double share, const Eigen::VectorXd& residual) const {
  Eigen::VectorXd squares(static_cast<Eigen::Index>(comparison_.cells().size()));
  for (Eigen::Index i = 0; i < squares.size(); ++i)
    squares[i] = share * share * comparison_.meanSquare(comparison_.cells()[static_cast<std::size_t>(i)], residual);
  return squares;
}

/// Mean over affected cells of ln(RMS / floor), where floor^2 = noise floor^2 + mismatch, but no less than 0 per cell.
double Odds::weighedMisfit(const Eigen::VectorXd& residual, const Eigen::VectorXd& mismatch) const {
  double sum = 0;
  for (Eigen::Index i = 0; i < mismatch.size(); ++i) {
    const Comparison::Cell& cell = comparison_.cells()[static_cast<std::size_t>(i)];
    sum += 0.5 * std::log(std::max(1.0, comparison_.meanSquare(cell, residual) / (cell.floor * cell.floor + mismatch[i])));
  }
  return sum / comparison_.affectedCells(nominal_residual_);
}

double Odds::misfitLeftBy(const Eigen::VectorXd& residual) const {
  return weighedMisfit(residual, mismatchOf(weighing_.law_mismatch, nominal_residual_));
}

/// What further effects gain where they do more than mend the law of the one that leaves least alone: the misfit with a large share of
/// what that one changes counted as noise, with it alone less with them.
double Odds::ownGain(const Eigen::VectorXd& residual, const Explanation& alone) const {
  const Eigen::VectorXd mismatch = mismatchOf(weighing_.mended_share, nominal_residual_ - alone.residual);
  return weighedMisfit(alone.judged(), mismatch) - weighedMisfit(residual, mismatch);
}

/// ln of the odds by what is left, and by what further effects gain of their own.
double Odds::ofMisfit(const Explanation& explanation, const Explanation& alone) const {
  return -weighing_.per_misfit * misfitLeftBy(explanation.judged()) + weighing_.per_own_gain * ownGain(explanation.judged(), alone);
}

/// Whether an effect acts where one before it does: on the same muscle, on the same signal, both on the body.
bool Odds::actsWhereOthersDo(const Explanation& explanation, std::size_t member) const {
  enum class Part { muscle, body, sensor };
  auto place = [&](std::size_t i) -> std::pair<Part, std::string> {
    const Suspect& suspect = suspects_[explanation.suspects[i]];
    switch (suspect.info().acts_on.front()) {
      case ComponentKind::signal:
        return {Part::sensor, suspect.component()};
      case ComponentKind::joint:
      case ComponentKind::hand:
      case ComponentKind::base:
        return {Part::body, "all"};
      default:
        return {Part::muscle, suspect.component()};
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

/// What speaks against an explanation before its misfit is looked at.
double Odds::beforehand(const Explanation& explanation) const {
  double odds = -weighing_.per_parameter * static_cast<double>(explanation.z.size()) -
                weighing_.per_effect * (static_cast<double>(explanation.suspects.size()) - 1);
  for (std::size_t i = 1; i < explanation.suspects.size(); ++i)
    if (actsWhereOthersDo(explanation, i)) odds -= weighing_.per_same_place;
  Eigen::Index first = 0;
  for (const std::size_t index : explanation.suspects) {
    const Suspect& suspect = suspects_[index];
    odds -= weighing_.per_excess * suspect.excess(explanation.z.segment(first, suspect.coordinateCount()));
    if (suspect.info().stage == Stage::sensor && suspect.component() == "all") odds -= weighing_.shared_sensor;
    first += suspect.coordinateCount();
  }
  return odds;
}

double Odds::ofExplanation(const Explanation& explanation, const Explanation& alone) const {
  return ofMisfit(explanation, alone) + beforehand(explanation);
}

double Odds::ofNoEffect() const {
  return -weighing_.per_misfit * misfitLeftBy(nominal_residual_);
}

double Odds::ofNoneOfThese() const {
  return weighing_.none_share * ofNoEffect() - weighing_.per_parameter;
}

double Odds::hopeBeyond(const Explanation& explanation, const Explanation& alone) const {
  Explanation perfect = explanation;
  perfect.unseen = Eigen::VectorXd::Zero(comparison_.size());
  return ofMisfit(perfect, alone) - ofMisfit(explanation, alone) - weighing_.per_effect - weighing_.per_parameter;
}

}  // namespace musclesim
