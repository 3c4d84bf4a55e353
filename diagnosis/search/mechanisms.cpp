// Laws with a further mechanism, such as a valve's second lag.
//
// A second lag is nearly a dead time, and half a filter is nearly half a delay. Where both are fitted, the misfit has a long flat valley
// with several minima, and a fit that begins at one end stays there. Instead the further mechanism's share is held at several values, one
// after the other, and everything else is fitted beside it, each time from where the last fit ended.
#include <algorithm>
#include <array>

#include "search.h"

namespace musclesim {

namespace {

constexpr std::array shares = {0.0, 0.25, 0.5, 1.0};  ///< of the range of a further mechanism
constexpr int held_rounds = 4;
constexpr std::size_t freed_count = 2;      ///< of the places reached, fitted on with nothing held
constexpr double beyond_every_range = 1e3;  ///< a coordinate

}  // namespace

/// The explanation at the other shares of each further mechanism of its laws, fitted in coarse steps. A law that it has without the
/// mechanism begins with a share of zero.
std::vector<Explanation> Search::alongFurtherMechanisms(const Explanation& explanation) const {
  std::vector<Explanation> places;
  const Explanation whole = causes_.withFurtherMechanisms(explanation);
  for (std::size_t m = 0; m < whole.members.size(); ++m) {
    for (const int own : causes_.hypotheses[whole.members[m]].furtherMechanisms()) {
      const Eigen::Index k = causes_.firstCoordinate(whole, m) + own;
      const auto boundOf = [&](double z) {
        return causes_.clamped(whole.members, movedBy(Eigen::VectorXd::Zero(whole.z.size()), k, z))[k];
      };
      const double none = boundOf(-beyond_every_range), full = boundOf(beyond_every_range);
      for (const bool upward : {true, false}) {
        Explanation at = whole;
        for (std::size_t i = 0; i < shares.size() && !plant_.interrupted(); ++i) {
          const double held = none + shares[upward ? i : shares.size() - 1 - i] * (full - none);
          if (upward ? held <= whole.z[k] : held >= whole.z[k]) continue;
          at.z[k] = held;
          causes_.refitHolding(at, k, fit_, held_rounds);
          if (at.residual.size() != fit_.size()) break;
          at.score = evidence().score(at);
          places.push_back(at);
        }
      }
    }
  }
  return places;
}

/// Fits the best explanations again from other shares of their laws' further mechanisms, also without them, and keeps what is better.
void Search::tryFurtherMechanisms() {
  std::ranges::stable_sort(explanations_, std::greater<>{}, &Explanation::score);
  const double least = explanations_.empty() ? 0 : explanations_.front().score - near_best;
  for (std::size_t rank = 0; rank < std::min(explanations_.size(), varied_count); ++rank) {
    Explanation& one = explanations_[rank];
    if (one.score < least || plant_.interrupted()) break;
    std::vector<Explanation> places = alongFurtherMechanisms(one);
    for (Explanation& place : places) {
      Explanation simple = causes_.withoutFurtherMechanisms(place);
      if (causes_.modelOf(simple).effects == causes_.modelOf(place).effects) place = std::move(simple);
    }
    improveBy(one, bestStarts(std::move(places), freed_count));
  }
}

/// The same effects with the further mechanisms that their laws leave out, fitted to the end; null if there are none, or if no such fit
/// does as well. The simpler laws are preferred where they do about as well, but their numbers may differ by more than their intervals.
std::shared_ptr<const Explanation> Search::withFurtherMechanisms(const Explanation& explanation) const {
  if (causes_.withFurtherMechanisms(explanation).members == explanation.members) return nullptr;
  std::vector<Explanation> places = alongFurtherMechanisms(explanation);
  if (places.empty() || plant_.interrupted()) return nullptr;
  Explanation best = *std::ranges::max_element(places, {}, &Explanation::score);
  goOn(best, Accuracy::estimates);
  if (best.residual.size() == fit_.size()) causes_.finish(best, fit_);
  if (best.residual.size() != fit_.size() || plant_.interrupted()) return nullptr;
  if (fit_.misfit(best.residual) > fit_.misfit(explanation.residual) + noticeable_loss) return nullptr;
  return std::make_shared<const Explanation>(std::move(best));
}

}  // namespace musclesim
