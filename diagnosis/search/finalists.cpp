// The likely explanations on all recordings: last fits, checks, probabilities.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "../../base/parallel.h"
#include "search.h"

namespace musclesim {

namespace {

constexpr double far_behind = 8;  ///< nats behind the best on the screening segments: not fitted to all recordings
constexpr std::size_t finalist_count = 10;
constexpr std::size_t always_count = 2;     ///< of each size
constexpr std::size_t restarted_count = 4;  ///< explanations near the best that are fitted from other strengths,
constexpr std::size_t start_count = 2;      ///< from so many starts each
constexpr std::size_t enlarged_count = 6;   ///< explanations near the best to which its further effects are added
constexpr int variant_passes = 3;           ///< changes of one effect's variant each
constexpr int coarse_rounds = 6, fine_rounds = 4;

}  // namespace

/// Whether a part of its effects does clearly better alone.
bool Search::isDominated(const Explanation& explanation) const {
  constexpr double clearly = 2;  // nats
  const std::set<std::string> labels = causes_.labelsOf(explanation.members);
  return std::ranges::any_of(pool_, [&](const Explanation& other) {
    return other.members.size() < explanation.members.size() && other.score > explanation.score + clearly &&
           std::ranges::includes(labels, causes_.labelsOf(other.members));
  });
}

/// The same effects with another variant of one of them: the search fits one variant only.
std::vector<Explanation> Search::otherVariants(const Explanation& explanation) const {
  std::vector<Explanation> result;
  const Model model = causes_.modelOf(explanation);
  for (std::size_t m = 0; m < explanation.members.size(); ++m)
    for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i) {
      if (i == explanation.members[m] || causes_.hypotheses[i].label() != causes_.hypotheses[explanation.members[m]].label()) continue;
      std::vector<Causes::Part> parts = causes_.partsOf(explanation);
      parts[m] = {i, causes_.hypotheses[i].coordinatesOf(model.effects[m].parameters)};
      result.push_back(Causes::assembled(parts, explanation.numbers));
    }
  return result;
}

/// Fits explanations side by side, drops those that could not be simulated, and puts the best first.
void Search::fitAll(std::vector<Explanation>& explanations, const std::function<void(Explanation&)>& fit) const {
  parallelFor(static_cast<int>(explanations.size()), options_.job_count, [&](int i) {
    if (!plant_.interrupted()) fit(explanations[static_cast<std::size_t>(i)]);
  });
  std::erase_if(explanations, [&](const Explanation& explanation) { return explanation.residual.size() != fit_.size(); });
  std::ranges::stable_sort(explanations, std::greater<>{}, &Explanation::score);
}

/// Drops what even a fit in fine steps cannot bring near the best. No effect, and the best of each size, stay.
void Search::dropHopeless() {
  std::set<std::size_t> sizes = {0};
  std::erase_if(explanations_, [&](const Explanation& explanation) {
    const bool is_first = sizes.insert(explanation.members.size()).second;
    return !explanation.members.empty() && !is_first && explanation.score < explanations_.front().score - far_behind;
  });
}

/// Fits the likely explanations, and no effect, to all recordings in fine steps and weighs them.
void Search::fitFinalists() {
  std::vector<std::size_t> best = bestOnScreening(0, pool_.size());
  const double least = best.empty() ? 0 : pool_[best.front()].score - far_behind;
  std::erase_if(best, [&](std::size_t index) { return pool_[index].score < least || isDominated(pool_[index]); });
  if (best.size() > finalist_count) best.resize(finalist_count);
  // Coarse steps may make much of a motion that is sensitive; there further effects seem to help.
  for (int size = 1; size <= options_.max_effects; ++size)
    for (const std::size_t index : bestOnScreening(static_cast<std::size_t>(size), always_count))
      if (std::ranges::find(best, index) == best.end()) best.push_back(index);
  for (const std::size_t index : best) explanations_.push_back(pool_[index]);
  explanations_.push_back(nothing_);
  fitAll(explanations_, [this](Explanation& explanation) { fitRoughly(explanation); });
  dropHopeless();
  fitAll(explanations_, [this](Explanation& explanation) { fitFinely(explanation); });
  tryEarlier();
  tryEffectsOfTheBest();
  tryOtherStrengths();
  tryVariants();
  tryFurtherMechanisms();
  tryLikeTheBest();
  tryExchanged();
  tryWithoutOne();
  weigh();
  polish();
  weigh();
  takeOutNothing();
  choose();
}

/// Exact parameters, scores and fresh intervals for the explanations that are listed, and for the numbers without any effect.
void Search::polish() {
  std::vector<Explanation*> chosen;
  for (Explanation& explanation : explanations_)
    if (explanation.probability >= least_listed || explanation.members.empty()) chosen.push_back(&explanation);
  parallelFor(static_cast<int>(chosen.size()), options_.job_count, [&](int i) {
    Explanation& explanation = *chosen[static_cast<std::size_t>(i)];
    if (plant_.interrupted() || explanation.residual.size() != fit_.size()) return;
    const Explanation before = explanation;
    goOn(explanation, Accuracy::estimates);
    if (explanation.residual.size() != fit_.size()) explanation = before;
    Explanation finished = explanation;
    causes_.finish(finished, fit_);
    if (plant_.interrupted()) return;
    explanation = std::move(finished);
    takeFromCounterparts(explanation);
    explanation.score = evidence().score(explanation);
    explanation.with_mechanisms = withFurtherMechanisms(explanation);
  });
}

/// The same effects with one of them half or twice as strong, and the numbers of the model as they were given.
std::vector<Explanation> Search::otherStrengths(const Explanation& explanation) const {
  std::vector<Explanation> result;
  for (std::size_t m = 0; m < explanation.members.size(); ++m)
    for (const double factor : {0.5, 2.0}) {
      Explanation other = explanation;
      for (const int strength : causes_.hypotheses[explanation.members[m]].strengths())
        other.z[causes_.firstCoordinate(explanation, m) + strength] *= factor;
      other.z = causes_.clamped(other.members, other.z);
      other.numbers.setZero();
      setCertainty(other, {});
      result.push_back(std::move(other));
    }
  return result;
}

/// Fits the best explanations again from where one of their effects is weaker or stronger, and keeps what is better: plays, thresholds and
/// dry friction make several minima.
void Search::tryOtherStrengths() {
  const double least = explanations_.empty() ? 0 : explanations_.front().score - near_best;
  for (std::size_t rank = 0; rank < std::min(explanations_.size(), restarted_count); ++rank) {
    Explanation& one = explanations_[rank];
    if (one.score < least || plant_.interrupted()) break;
    improveBy(one, bestStarts(otherStrengths(one), start_count));
  }
}

/// Scores several starts without fitting them, and returns the best.
std::vector<Explanation> Search::bestStarts(std::vector<Explanation> starts, std::size_t most) const {
  fitAll(starts, [this](Explanation& start) {
    causes_.refit(start, fit_, 0, Fidelity::coarse, Accuracy::ranking);
    if (start.residual.size() == fit_.size()) start.score = evidence().score(start);
  });
  if (starts.size() > most) starts.resize(most);
  return starts;
}

/// Fits all explanations roughly, drops those that do not reach the score, and fits the rest to the end.
void Search::fitIfPromising(std::vector<Explanation>& explanations, double least_score) const {
  fitAll(explanations, [&](Explanation& one) { fitRoughly(one, least_score); });
  std::erase_if(explanations, [&](const Explanation& one) { return one.score < least_score; });
  fitAll(explanations, [this](Explanation& one) { fitFinely(one); });
}

/// Fits others from their starts and puts the best of them in the place of `one` if it is better. Returns whether it is.
bool Search::improveBy(Explanation& one, std::vector<Explanation> others) const {
  fitIfPromising(others, one.score - worth_polishing);
  if (others.empty() || others.front().score <= one.score) return false;
  one = std::move(others.front());
  return true;
}

/// Replaces the best explanations by other variants of themselves that are better, one effect's variant after the other.
void Search::tryVariants() {
  std::ranges::stable_sort(explanations_, std::greater<>{}, &Explanation::score);
  const double least = explanations_.empty() ? 0 : explanations_.front().score - near_best;
  for (std::size_t rank = 0; rank < std::min(explanations_.size(), varied_count); ++rank) {
    Explanation& one = explanations_[rank];
    for (int pass = 0; pass < variant_passes && one.score >= least && !plant_.interrupted(); ++pass)
      if (!improveBy(one, otherVariants(one))) break;
  }
}

/// Fits the explanations near the best from where the best ended, for all that they share with it. Fits that end in different minima of
/// the effects which both have say nothing about the effects in which they differ.
void Search::tryLikeTheBest() {
  if (explanations_.empty() || plant_.interrupted()) return;
  std::ranges::stable_sort(explanations_, std::greater<>{}, &Explanation::score);
  const Explanation best = explanations_.front();
  std::vector<std::size_t> ranks;
  for (std::size_t rank = 1; rank < std::min(explanations_.size(), varied_count + 1) && explanations_[rank].score > best.score - far_behind;
       ++rank)
    if (!explanations_[rank].members.empty()) ranks.push_back(rank);
  parallelFor(static_cast<int>(ranks.size()), options_.job_count, [&](int i) {
    Explanation& one = explanations_[ranks[static_cast<std::size_t>(i)]];
    Explanation other = causes_.takingOver(one, best);
    if (plant_.interrupted()) return;
    fitRoughly(other, one.score - worth_polishing);
    if (other.residual.size() != fit_.size() || other.score < one.score - worth_polishing) return;
    fitFinely(other);
    if (other.residual.size() == fit_.size() && other.score > one.score) one = std::move(other);
  });
}

/// The best explanation with effects that may act alike exchanged: it may have become the best one only here.
void Search::tryExchanged() {
  std::ranges::stable_sort(explanations_, std::greater<>{}, &Explanation::score);
  if (explanations_.empty() || plant_.interrupted()) return;
  std::vector<Explanation> others;
  for (Proposal& proposal : exchanged(explanations_.front())) others.push_back(std::move(proposal.start));
  keepIfBetter(std::move(others));
}

/// The parts of the best explanation that lack one effect, from where it ended: their own fits may have ended elsewhere, for example where
/// the motion is sensitive, so that the further effect only seems to help. Explanations near the best are treated in the same way, if the
/// part is among the explanations.
void Search::tryWithoutOne() {
  for (int pass = 0; pass < options_.max_effects && !plant_.interrupted(); ++pass) {
    std::ranges::stable_sort(explanations_, std::greater<>{}, &Explanation::score);
    const Explanation best = explanations_.front();
    std::vector<Explanation> smaller;
    for (const Explanation& whole : explanations_)
      for (std::size_t m = 0; m < whole.members.size() && whole.members.size() > 1 && whole.score >= best.score - near_best; ++m) {
        Explanation part = causes_.without(whole, m);
        if (whole.members == best.members || sameAmong(explanations_, part) != explanations_.end()) smaller.push_back(std::move(part));
      }
    keepIfBetter(std::move(smaller));
    if (std::ranges::max_element(explanations_, {}, &Explanation::score)->members == best.members) return;
  }
}

/// The earlier finding with the values that were given: the search fitted it in coarse steps, from where another minimum may be nearer.
void Search::tryEarlier() {
  if (!options_.earlier.empty()) keepIfBetter({earlierFinding()});
}

/// Explanations near the best one, each with an effect more that only the best one has: two sets that are equally good may differ in two
/// effects that belong together. Example: one muscle's pressure is too low and the other muscle too weak, or the sensor of the pressure
/// reads too little and the other muscle is mounted too long; a payload acts in both, but was only tried beside the second.
void Search::tryEffectsOfTheBest() {
  if (explanations_.empty() || plant_.interrupted()) return;
  std::ranges::stable_sort(explanations_, std::greater<>{}, &Explanation::score);
  const Explanation& best = explanations_.front();
  const Model model = causes_.modelOf(best);
  const double least_score = best.score - near_best;
  std::vector<Explanation> larger;
  std::size_t enlarged = 0;
  for (const Explanation& near : explanations_) {
    if (near.score < least_score || enlarged == enlarged_count) break;
    if (near.members.empty() || static_cast<int>(near.members.size()) >= options_.max_effects) continue;
    ++enlarged;
    for (std::size_t m = 0; m < best.members.size(); ++m) {
      if (!fitsBeside(best.members[m], near.members)) continue;
      Explanation one = causes_.with(near, best.members[m], model.effects[m].parameters);
      if (sameAmong(explanations_, one) == explanations_.end() && sameAmong(larger, one) == larger.end()) larger.push_back(std::move(one));
    }
  }
  fitIfPromising(larger, least_score);
  std::ranges::move(larger, std::back_inserter(explanations_));
  std::ranges::stable_sort(explanations_, std::greater<>{}, &Explanation::score);
}

/// Evaluates each start. Where it is better than the same set among the explanations, or that set is new, fits it in fine steps and takes
/// it over.
void Search::keepIfBetter(std::vector<Explanation> ones) {
  fitAll(ones, [this](Explanation& one) {
    causes_.refit(one, fit_, 0, Fidelity::fine, Accuracy::ranking);
    if (one.residual.size() == fit_.size()) one.score = evidence().score(one);
  });
  for (Explanation& one : ones) {
    const auto same = sameAmong(explanations_, one);
    if (same != explanations_.end() && same->score >= one.score) continue;
    fitFinely(one);
    if (one.residual.size() != fit_.size() || (same != explanations_.end() && same->score >= one.score)) continue;
    if (same == explanations_.end())
      explanations_.push_back(std::move(one));
    else
      *same = std::move(one);
  }
}

/// In coarse steps. Ends early where no score above the least one is promised.
void Search::fitRoughly(Explanation& explanation, double least_score) const {
  causes_.refit(explanation, fit_, coarse_rounds, Fidelity::coarse, Accuracy::ranking, {}, Known::elsewhere,
                evidence().largestCost(explanation, least_score - promise_error));
  if (explanation.residual.size() == fit_.size()) explanation.score = evidence().score(explanation);
}

/// In fine steps.
void Search::fitFinely(Explanation& explanation) const {
  goOn(explanation, Accuracy::ranking);
  if (explanation.residual.size() != fit_.size()) return;
  explanation.is_inactive = hasInactiveEffect(explanation);
  explanation.score = evidence().score(explanation);
}

/// Fits on in fine steps; the derivatives found last, in whatever steps, serve at first.
void Search::goOn(Explanation& explanation, Accuracy accuracy) const {
  std::vector<SharedVector> known;
  for (Eigen::Index k = 0; k < explanation.jacobian.cols(); ++k)
    known.push_back(std::make_shared<const Eigen::VectorXd>(explanation.jacobian.col(k)));
  causes_.refit(explanation, fit_, fine_rounds, Fidelity::fine, accuracy, std::move(known), Known::here);
}

/// A parameter that the recordings do not determine takes the value of the other direction: a valve of which only the venting was recorded
/// is taken to fill at the same rate.
void Search::takeFromCounterparts(Explanation& explanation) const {
  constexpr double noticeable = 0.1;  // nats
  Explanation changed = explanation;
  Eigen::Index first = 0;
  for (const std::size_t index : explanation.members) {
    const Hypothesis& hypothesis = causes_.hypotheses[index];
    for (int k = 0; k < hypothesis.coordinateCount(); ++k) {
      const int other = hypothesis.counterpartOf(k);
      if (other < 0 || std::isfinite(explanation.half_width[first + k]) || !std::isfinite(explanation.half_width[first + other])) continue;
      changed.z[first + k] = hypothesis.coordinateLike(k, other, explanation.z[first + other]);
    }
    first += hypothesis.coordinateCount();
  }
  changed.z = causes_.clamped(changed.members, changed.z);
  if (changed.z == explanation.z || plant_.interrupted()) return;
  causes_.refit(changed, fit_, 0, Fidelity::fine, Accuracy::ranking);
  if (changed.residual.size() != fit_.size() || fit_.misfit(changed.residual) > fit_.misfit(explanation.residual) + noticeable) return;
  changed.jacobian = explanation.jacobian;
  explanation = changed;
}

/// True if an effect's strength can go to nearly zero at no noticeable loss: its shape parameters explain the data, not the effect. For
/// example a leak without a leak is the lag of its regulator.
bool Search::hasInactiveEffect(const Explanation& explanation) const {
  constexpr double next_to_nothing = 1e-3;  // typical strengths
  const Eigen::VectorXd as_it_is = fit_.predicted(causes_.modelOf(explanation));
  Eigen::Index first = 0;
  for (const std::size_t index : explanation.members) {
    const Hypothesis& hypothesis = causes_.hypotheses[index];
    const auto strength_count = static_cast<int>(hypothesis.strengths().size());
    if (strength_count > 0 && strength_count < hypothesis.coordinateCount() && as_it_is.size() && !plant_.interrupted()) {
      Explanation weak = explanation;
      for (const int strength : hypothesis.strengths()) weak.z[first + strength] = next_to_nothing;
      weak.z = causes_.clamped(weak.members, weak.z);
      const Eigen::VectorXd predicted = fit_.predicted(causes_.modelOf(weak));
      on_simulation_();
      if (predicted.size() == fit_.size() && predicted.allFinite() &&
          fit_.misfit(explanation.residual + as_it_is - predicted) < fit_.misfit(explanation.residual) + noticeable_loss)
        return true;
    }
    first += hypothesis.coordinateCount();
  }
  return false;
}

/// Computes the probabilities of the explanations, no effect among them, and apart from them that of something else.
void Search::weigh() {
  if (explanations_.empty()) return;  // nothing is known yet
  const double largest = std::ranges::max_element(explanations_, {}, &Explanation::score)->score;
  if (!std::isfinite(largest)) return;
  double sum = 0;
  for (Explanation& explanation : explanations_) sum += explanation.probability = std::exp(explanation.score - largest);
  for (Explanation& explanation : explanations_) explanation.probability /= sum;
  something_else_ = evidence().ofSomethingElse(explanations_);
  std::ranges::stable_sort(explanations_, std::greater<>{}, &Explanation::probability);
}

/// Moves the explanation that namedSet() selects to the front. Only explanations with a probability of `least_listed` or more can be
/// selected.
void Search::choose() {
  std::vector<std::set<std::string>> sets;
  std::vector<double> probabilities;
  for (const Explanation& explanation : explanations_) {
    if (explanation.probability < least_listed && !sets.empty()) break;
    sets.push_back(causes_.labelsOf(explanation.members));
    probabilities.push_back(explanation.probability);
  }
  if (sets.empty()) return;
  const auto chosen = explanations_.begin() + static_cast<std::ptrdiff_t>(namedSet(sets, probabilities));
  std::rotate(explanations_.begin(), chosen, chosen + 1);
}

void Search::takeOutNothing() {
  const auto nothing = std::ranges::find_if(explanations_, [](const Explanation& explanation) { return explanation.members.empty(); });
  if (nothing != explanations_.end()) {
    nothing_ = *nothing;
    explanations_.erase(nothing);
  }
}

}  // namespace musclesim
