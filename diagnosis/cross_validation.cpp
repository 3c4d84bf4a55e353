// Two checks of fitted hypotheses beyond their misfit: cross-validation on recordings that their parameters were not fitted to, and whether
// an effect is inactive.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "../base/parallel.h"
#include "attribute.h"
#include "data_checks.h"

namespace musclesim {

/// The step to the optimum of the linearised problem without some segments, reweighted five times. Coordinates stop at bounds, and at a
/// typical strength or twice their value, whichever is farther.
Eigen::VectorXd Attributor::stepWithout(const std::set<std::size_t>& left_out, const FittedHypothesis& fitted,
                                        const Eigen::MatrixXd& jacobian) const {
  constexpr int reweightings = 5;
  constexpr double damping = 1e-3;  // coordinates without influence stay where they are
  const Eigen::VectorXd longest_step = fitted.z.cwiseAbs().cwiseMax(1.0);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(jacobian.cols()), kept = step;
  Eigen::MatrixXd free = jacobian;
  for (int i = 0; i < reweightings && step.size() > 0; ++i) {
    Eigen::VectorXd weights = fit_.weights(fitted.residual - jacobian * step);
    for (const Comparison::Block& block : fit_.blocks())
      if (left_out.contains(block.segment)) weights.segment(block.first, block.count()).setZero();
    const Eigen::MatrixXd weighted = weights.asDiagonal() * free;
    Eigen::MatrixXd normal = weighted.transpose() * weighted;
    normal.diagonal().array() += damping;
    step = kept + normal.ldlt().solve(weighted.transpose() * weights.cwiseProduct(fitted.residual - jacobian * kept));
    const Eigen::VectorXd possible = clampedAll(fitted.members, fitted.z + step.cwiseMax(-longest_step).cwiseMin(longest_step)) - fitted.z;
    for (Eigen::Index k = 0; k < step.size(); ++k)
      if (possible[k] != step[k] && std::abs(possible[k] - step[k]) > 1e-9) {
        kept[k] = step[k] = possible[k];
        free.col(k).setZero();
      }
  }
  return step;
}

/// The part of a vector over all segments that belongs to one of them, in the order of that segment's own comparison.
Eigen::VectorXd Attributor::partOf(std::size_t segment, const Eigen::VectorXd& all) const {
  const Comparison& one = one_by_one_[segment];
  Eigen::VectorXd part(one.size());
  for (const Comparison::Block& block : fit_.blocks())
    if (block.segment == segment) {
      const Comparison::Block& same = one.blockLike(block);
      part.segment(same.first, same.count()) = all.segment(block.first, block.count());
    }
  return part;
}

/// The unmoved fit: its misfit per segment with fine time steps, and the difference between fine and coarse prediction.
Attributor::Unmoved Attributor::unmoved(const FittedHypothesis& fitted) const {
  Unmoved result{std::vector<double>(one_by_one_.size()), std::vector<Eigen::VectorXd>(one_by_one_.size())};
  parallelFor(static_cast<int>(one_by_one_.size()), options_.job_count, [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    const Comparison& one = one_by_one_[k];
    const Eigen::VectorXd residual = partOf(k, fitted.residual), coarse = one.predicted(modelOf(fitted));
    on_simulation_();
    result.misfit[k] = one.logMisfit(residual);
    result.shift[k] = coarse.size() ? Eigen::VectorXd(one.measured() - residual - coarse) : Eigen::VectorXd::Zero(one.size());
  });
  return result;
}

/// The fit moved by a step, or by a half or a quarter of it if the full step fits the segments that are kept worse than the unmoved fit.
/// Coarse predictions are corrected by the fine-minus-coarse difference of the unmoved fit.
FittedHypothesis Attributor::movedWithout(const std::set<std::size_t>& left_out, const FittedHypothesis& fitted, Eigen::VectorXd step,
                                          const Unmoved& unmoved) const {
  constexpr int halving_count = 3;
  const double worse = 0.02 * fit_.affectedBlocks(nominal_residual_);  // increase of the misfit that is tolerated
  FittedHypothesis moved = fitted;
  auto gainOf = [&](std::size_t k) {
    const Eigen::VectorXd coarse = one_by_one_[k].predicted(modelOf(moved));
    on_simulation_();
    if (!coarse.size()) return -std::numeric_limits<double>::infinity();
    return unmoved.misfit[k] - one_by_one_[k].logMisfit(one_by_one_[k].measured() - coarse - unmoved.shift[k]);
  };
  double gain = 0;
  for (int i = 0; i < halving_count && step.size(); ++i, step *= 0.5) {
    moved.z = clampedAll(fitted.members, fitted.z + step);
    gain = worse;
    for (std::size_t k = 0; k < one_by_one_.size(); ++k)
      if (!left_out.contains(k)) gain += gainOf(k);
    if (gain > 0) break;
  }
  return std::isfinite(gain) ? moved : fitted;
}

/// Leave-one-out cross-validation (Stone 1974): predicts each segment with parameters fitted to the others; repeats of the segment are left
/// out too. These parameters differ from the fit to all segments by the steps of the linearised problem with and without the segment,
/// shortened if they fit the others worse. If the model diverges with them, the residual without effects is used. Tuned parameters stay
/// fixed, because the model without effects keeps them too.
void Attributor::predictFromOthers(FittedHypothesis& fitted) const {
  FitProblem problem = problemOf(fitted, fit_, Fidelity::coarse);
  const Eigen::Index effect_count = fitted.z.size();
  const Eigen::MatrixXd jacobian =
      effect_count ? derivatives(fit_, problem, problem.start).leftCols(effect_count).eval() : Eigen::MatrixXd(fit_.size(), 0);
  const Eigen::VectorXd with_all = stepWithout({}, fitted, jacobian);
  const Unmoved as_it_is = effect_count ? unmoved(fitted) : Unmoved{};
  Eigen::VectorXd cross_validated = fitted.residual;
  parallelFor(static_cast<int>(one_by_one_.size()), options_.job_count, [&](int i) {
    if (plant_.interrupted()) return;
    const auto k = static_cast<std::size_t>(i);
    const std::set<std::size_t> left_out = sameCommandsAs(k);
    const Eigen::VectorXd step = stepWithout(left_out, fitted, jacobian) - with_all;
    const FittedHypothesis without = movedWithout(left_out, fitted, step, as_it_is);
    const Comparison& one = one_by_one_[k];
    Eigen::VectorXd left = one.predicted(modelOf(without), Fidelity::fine);
    on_simulation_();
    const bool goes_on = left.size() == one.size() && left.allFinite();
    if (goes_on) left = one.measured() - left;
    for (const Comparison::Block& block : fit_.blocks()) {
      if (block.segment != k) continue;
      const Eigen::VectorXd& source = goes_on ? left : nominal_residual_;
      cross_validated.segment(block.first, block.count()) =
          source.segment(goes_on ? one.blockLike(block).first : block.first, block.count());
    }
  });
  if (!plant_.interrupted()) fitted.cross_validated = cross_validated;
}

/// The segment itself and its repeats.
std::set<std::size_t> Attributor::sameCommandsAs(std::size_t segment) const {
  auto recordingOf = [&](std::size_t k) -> const Recording& {
    return plant_.recordings()[static_cast<std::size_t>(fit_.segments()[k].recording)];
  };
  std::set<std::size_t> result = {segment};
  for (std::size_t k = 0; k < fit_.segments().size(); ++k)
    if (isRepeat(recordingOf(k), recordingOf(segment))) result.insert(k);
  return result;
}

/// True if an effect's strength can go to nearly zero at no noticeable loss: its shape parameters explain the data, not the effect. For
/// example a leak without a leak is the lag of its regulator.
bool Attributor::hasInactiveEffect(const FittedHypothesis& fitted) const {
  constexpr double next_to_nothing = 1e-3, noticeable = 0.45;  // typical strengths; ln odds
  if (fitted.residual.size() != fit_.size()) return false;
  const Eigen::VectorXd as_it_is = fit_.predicted(modelOf(fitted));
  Eigen::Index first = 0;
  for (const std::size_t index : fitted.members) {
    const Hypothesis& hypothesis = result_.hypotheses[index];
    const auto strength_count = static_cast<int>(hypothesis.strengths().size());
    if (strength_count > 0 && strength_count < hypothesis.coordinateCount() && as_it_is.size() && !plant_.interrupted()) {
      FittedHypothesis weak = fitted;
      for (const int strength : hypothesis.strengths()) weak.z[first + strength] = next_to_nothing;
      weak.z = clampedAll(weak.members, weak.z);
      const Eigen::VectorXd predicted = fit_.predicted(modelOf(weak));
      on_simulation_();
      if (predicted.size() == fit_.size() && predicted.allFinite() &&
          odds().ofMisfit(fitted.residual + as_it_is - predicted) > odds().ofMisfit(fitted.residual) - noticeable)
        return true;
    }
    first += hypothesis.coordinateCount();
  }
  return false;
}

/// Fits every hypothesis that is not improbable to all fitting segments and cross-validates it, and each of its effects alone, until none
/// is left.
void Attributor::crossCheck() {
  constexpr double out_of_the_question = 0.001;
  const bool some_unlike = sameCommandsAs(0).size() < fit_.segments().size();
  if (some_unlike && one_by_one_.empty())
    for (const Segment& segment : fit_.segments()) {
      Comparison& one = one_by_one_.emplace_back(plant_, std::vector{segment}, Comparison::Averages::with);
      one.goCoarse(one.predicted(Model{}));
    }
  while (!plant_.interrupted()) {
    std::set<std::size_t> members;
    for (const FittedHypothesis& fitted : result_.fits)
      if (fitted.probability > out_of_the_question) members.insert(fitted.members.begin(), fitted.members.end());
    std::vector<FittedHypothesis*> open;
    for (FittedHypothesis& fitted : result_.fits) {
      const bool alone = fitted.members.size() == 1 && members.contains(fitted.members.front());
      const bool done = fitted.fitted_to_all && (fitted.cross_validated.size() > 0 || !some_unlike);
      if (!done && (alone || fitted.probability > out_of_the_question)) open.push_back(&fitted);
    }
    if (open.empty()) return;
    parallelFor(static_cast<int>(open.size()), options_.job_count, [&](int i) {
      FittedHypothesis& fitted = *open[static_cast<std::size_t>(i)];
      if (!fitted.fitted_to_all) refit(fitted, fit_, more_rounds, Fidelity::coarse);
      fitToAll(fitted);
      if (some_unlike && fitted.residual.size() == fit_.size()) predictFromOthers(fitted);
    });
    // The model may diverge with fine time steps though not with coarse ones.
    std::erase_if(result_.fits, [&](const FittedHypothesis& fitted) { return fitted.residual.size() != fit_.size(); });
    if (!plant_.interrupted()) weigh();
  }
}

}  // namespace musclesim
