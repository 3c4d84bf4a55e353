// Stand-ins: every member of the likely sets is replaced by what could act in its place.
#include <algorithm>
#include <iterator>
#include <string_view>

#include "../../base/parallel.h"
#include "search.h"

namespace musclesim {

namespace {

constexpr std::size_t base_count = 4;          ///< best sets of whose members each is replaced
constexpr int most_bases = 12;                 ///< sets in all, while better ones come up; base_count more for a late one
constexpr std::size_t beside_all_count = 40;   ///< effects that are simulated beside such a set,
constexpr std::size_t beside_rest_count = 20;  ///< and beside the rest of it without one member
constexpr std::size_t replacement_count = 4;   ///< single effects that are fitted in the place of a member,
constexpr int variant_count = 2;               ///< in so many variants,
constexpr std::size_t pair_count = 2;          ///< pairs,
constexpr std::size_t same_place_count = 3;    ///< and effects of the member's place
constexpr std::size_t most_best = 3;           ///< sets that are the best one in the end: all effects of their members' places are fitted
constexpr std::size_t pair_base_count = 8;     ///< effects that do best alone, one of which every such pair has

}  // namespace

/// Two further effects: one often takes in what two make, so that neither lowers the cost alone. Pairs are formed of the effects that cost
/// least if added alone (pair_base_count) with any other, and of the same effect on two components.
std::vector<Search::Proposal> Search::pairs(const Surroundings& around) const {
  if (static_cast<int>(around.base.members.size()) + 2 > options_.max_effects) return {};
  std::vector<std::size_t> order;
  std::set<std::string> labels;
  for (const std::size_t index : inOrderOf(costsOfAdding(around)))
    if (labels.insert(causes_.hypotheses[index].label()).second) order.push_back(index);
  std::vector<std::vector<std::size_t>> pairs;
  for (std::size_t i = 0; i < std::min(pair_base_count, order.size()); ++i)
    for (std::size_t k = i + 1; k < order.size(); ++k)
      if (!causes_.clash(order[i], order[k])) pairs.push_back({order[i], order[k]});
  std::ranges::move(twins(around), std::back_inserter(pairs));
  return proposedEach(around, pairs);
}

/// One effect on a single component put on all of them, in place of all members of its kind: faults of muscles of one build often are
/// alike, and two of them on single muscles cost more than one on all. There is no estimate of what such a set costs: with 0 it promises
/// everything, so that it is fitted from here even if it is known.
std::vector<Search::Proposal> Search::widened(const Explanation& base) const {
  std::vector<Proposal> result;
  const Model model = causes_.modelOf(base);
  for (std::size_t m = 0; m < base.members.size(); ++m)
    for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i) {
      const Hypothesis &one = causes_.hypotheses[base.members[m]], &on_all = causes_.hypotheses[i];
      if (on_all.component() != "all" || one.component() == "all" || on_all.info().id != one.info().id || !catalogue_.allowed[i]) continue;
      Explanation wide = base;
      for (std::size_t k = wide.members.size(); k-- > 0;)
        if (causes_.clash(i, wide.members[k])) wide = causes_.without(wide, k);
      result.push_back({causes_.with(wide, i, model.effects[m].parameters), 0});
    }
  return result;
}

/// Each member replaced by every effect whose strengths have the same names, at the same values. Example: a dead time of all commands and
/// one of all sensors act alike, but if commands jump, the misfit jumps with the dead time, and a fit that begins at another time may end
/// in another minimum. Only effects that could act on a single place ("all", or the only muscle) are exchanged. As for widened(), nothing
/// estimates the cost.
std::vector<Search::Proposal> Search::exchanged(const Explanation& base) const {
  std::vector<Proposal> result;
  const Model model = causes_.modelOf(base);
  for (std::size_t m = 0; m < base.members.size(); ++m)
    for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i) {
      const Hypothesis &one = causes_.hypotheses[base.members[m]], &other = causes_.hypotheses[i];
      const Explanation rest = causes_.without(base, m);
      if (one.info().id == other.info().id || one.placeCount() > 1 || other.placeCount() > 1 || one.strengths().empty() ||
          one.strengthNames() != other.strengthNames() || !fitsBeside(i, rest.members))
        continue;
      result.push_back({causes_.with(rest, i, model.effects[m].parameters), 0});
    }
  return result;
}

/// The member's place, and the place that the same readings may come from: if a pressure in one muscle is wrong, its sensor may be, and the
/// reverse. Only the motion tells these apart, and other members can take up what it tells.
std::vector<std::string> Search::placesLike(std::size_t hypothesis) const {
  const Hypothesis& one = causes_.hypotheses[hypothesis];
  std::vector<std::string> places = {one.place()};
  constexpr std::string_view muscle = "muscle_", reading = "signal_pressure_";
  const auto componentLike = [&](std::string_view own, std::string_view other) {
    return one.component().starts_with(own) ? std::string(other) + one.component().substr(own.size()) : std::string();
  };
  const auto isBeforePressure = [](const Hypothesis& other) {
    return other.info().stage == Stage::command || other.info().stage == Stage::pressure;
  };
  const bool is_sensor = one.info().stage == Stage::sensor;
  const std::string like = isBeforePressure(one) ? componentLike(muscle, reading) : is_sensor ? componentLike(reading, muscle) : "";
  const auto found = std::ranges::find_if(causes_.hypotheses, [&](const Hypothesis& other) {
    return other.component() == like && (is_sensor ? isBeforePressure(other) : other.info().stage == Stage::sensor);
  });
  if (found != causes_.hypotheses.end()) places.push_back(found->place());
  return places;
}

/// The effects that, alone or as a pair, explain best what the set leaves unexplained without one member, and the nearest of those of the
/// places like the member's: flow limits and friction do not act in proportion, so that little follows from what they change beside no
/// effect. `beside_all` are the changes that the catalogue makes beside all members. Every rest is tried once for each place.
std::vector<Search::Proposal> Search::standIns(const Explanation& base, std::size_t member, const std::vector<Sensitivity>& beside_all) {
  std::vector<std::string> places = placesLike(base.members[member]);
  Explanation rest = causes_.without(base, member);
  const std::set<std::string> labels = causes_.labelsOf(rest.members);
  std::erase_if(places, [&](const std::string& place) { return !places_tried_.insert({labels, place}).second; });
  if (places.empty()) return {};
  if (rest.members.empty()) return additionsAt(places, about_nothing_.front(), causes_.hypotheses.size());
  if (!predictResidual(rest)) return {};
  const bool is_new = stood_in_.insert(labels).second;
  const Surroundings around = surroundingsOf(rest, {is_new ? beside_rest_count : 0, variant_count, &beside_all, places});
  std::vector<Proposal> result = additionsAt(places, around, same_place_count);
  if (is_new)
    for (Proposal& proposal : bestAdded(around))
      if (std::ranges::none_of(result, [&](const Proposal& other) { return other.start.members == proposal.start.members; }))
        result.push_back(std::move(proposal));
  return result;
}

/// Replaces the member by each effect of the places like its own, and returns the sets that have not been fitted yet. All of them are worth
/// a fit, because linear models can promise ten nats too little. Example: dry friction turns a motion into steps. A dead time of 0.16 s
/// shifts them; to replace it by one of 0.06 s and a lag is no small change, although both fit nearly the same readings.
std::vector<Search::Proposal> Search::allStandIns(const Explanation& base, std::size_t member, const std::vector<Sensitivity>& beside_all) {
  const std::vector<std::string> places = placesLike(base.members[member]);
  Explanation rest = causes_.without(base, member);
  if (rest.members.empty() || !predictResidual(rest)) return {};  // single effects have all been fitted
  const Surroundings around = surroundingsOf(rest, {0, variant_count, &beside_all, places});
  std::vector<Proposal> result = additionsAt(places, around, causes_.hypotheses.size());
  std::erase_if(result, [&](const Proposal& proposal) { return sameAmong(pool_, proposal.start) != pool_.end(); });
  return result;
}

/// Predicts what an explanation leaves; false if it diverges, and once interrupted.
bool Search::predictResidual(Explanation& explanation) const {
  if (plant_.interrupted()) return false;
  const Eigen::VectorXd predicted = screening_.predicted(causes_.modelOf(explanation));
  on_simulation_();
  if (predicted.size() != screening_.size()) return false;
  explanation.residual = screening_.measured() - predicted;
  return true;
}

/// The nearest additions of each of the places.
std::vector<Search::Proposal> Search::additionsAt(const std::vector<std::string>& places, const Surroundings& around,
                                                  std::size_t count_per_place) const {
  const std::vector<Proposal> all = additions(around);
  std::vector<Proposal> result;
  for (const std::string& place : places) {
    std::vector<Proposal> here;
    for (const Proposal& proposal : all)
      if (causes_.hypotheses[proposal.start.members.back()].place() == place) here.push_back(proposal);
    std::ranges::move(nearest(std::move(here), count_per_place), std::back_inserter(result));
  }
  return result;
}

/// The best additions of one effect and of two.
std::vector<Search::Proposal> Search::bestAdded(const Surroundings& around) const {
  std::vector<Proposal> result = nearest(additions(around), replacement_count, variant_count);
  std::ranges::move(nearest(pairs(around), pair_count), std::back_inserter(result));
  return result;
}

/// Tries stand-ins of every member of the best sets, what is missing beside all members, and the sets' widened and exchanged forms. A swap
/// that is estimated where the member acts takes the change that the stand-in makes there as proportional, up to all that the member
/// explains; friction beside friction, for one, is far from that. So the member is taken away first, and what promises most there, by its
/// changes beside nothing or beside all members, is simulated there. In the place of each member of the best set every effect of its place
/// is fitted in the end, whatever it promises; what does better is tried in the same way.
void Search::tryStandIns() {
  std::set<std::set<std::string>> done, exhausted;
  std::vector<Sensitivity> beside;  // the set before
  for (int count = 0; !plant_.interrupted();) {
    const std::vector<std::size_t> order = bestOnScreening(0, base_count);
    if (order.empty()) return;
    const auto next = std::ranges::find_if(order, [&](std::size_t i) { return !done.contains(causes_.labelsOf(pool_[i].members)); });
    const bool is_last = count == most_bases || next == order.end() || pool_[*next].score < pool_[order.front()].score - hopeless;
    const Explanation base = pool_[is_last ? order.front() : *next];  // the pool grows below
    std::vector<Proposal> proposals;
    if (is_last) {
      if (exhausted.size() == most_best || !exhausted.insert(causes_.labelsOf(base.members)).second) return;
      for (std::size_t m = 0; m < base.members.size(); ++m) std::ranges::move(allStandIns(base, m, beside), std::back_inserter(proposals));
      count = std::min(count, most_bases - static_cast<int>(base_count));  // what does better is tried like the others
    } else {
      ++count;
      done.insert(causes_.labelsOf(base.members));
      const Surroundings around = surroundingsOf(base, {beside_all_count, variant_count, beside.empty() ? nullptr : &beside});
      beside = around.sensitivities;
      if (static_cast<int>(base.members.size()) < options_.max_effects && stood_in_.insert(causes_.labelsOf(base.members)).second)
        proposals = bestAdded(around);
      for (std::size_t m = 0; m < base.members.size(); ++m)
        std::ranges::move(standIns(base, m, around.sensitivities), std::back_inserter(proposals));
      std::ranges::move(nearest(widened(base), wide_count, 2), std::back_inserter(proposals));
      std::ranges::move(nearest(exchanged(base), wide_count), std::back_inserter(proposals));
    }
    fitOnScreening(std::move(proposals));
  }
}

}  // namespace musclesim
