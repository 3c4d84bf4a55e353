#include "search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>

#include "../../base/parallel.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr std::size_t single_count = 9;                    ///< single effects that are fitted
constexpr std::size_t per_stage_count = 2;                 ///< and at least so many of every stage
constexpr std::size_t beam_width = 5;                      ///< sets of each size that the linear search keeps
constexpr std::size_t addition_count = 3, drop_count = 4;  ///< sets that are fitted about one explanation, besides one of each stage
constexpr std::size_t base_counts[most_effects] = {5, 2, 2, 1, 1, 1};  ///< explanations of each size that are extended
constexpr std::size_t neighbour_count = 30;  ///< effects that are simulated beside an explanation that is extended
constexpr int screening_rounds = 4;

}  // namespace

Search::Search(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation)
    : plant_(plant),
      options_(options),
      on_simulation_(std::move(on_simulation)),
      causes_(plant, on_simulation_),
      screening_(plant, plant.screeningSegments(), Comparison::Derived::with),
      fit_(plant, plant.split().fit, Comparison::Derived::with) {}

/// Whether the set was fitted and did not end far from what is promised now: a fit that began elsewhere may have ended in a local minimum.
bool Search::isKnown(const Proposal& proposal) const {
  constexpr double far = 3;  // nats; linear estimates are optimistic
  const auto known = sameAmong(pool_, proposal.start);
  return known != pool_.end() && known->score > -proposal.cost - far;
}

bool Search::fitsBeside(std::size_t hypothesis, const std::vector<std::size_t>& members) const {
  return catalogue_.allowed[hypothesis] &&
         std::ranges::none_of(members, [&](std::size_t member) { return causes_.clash(hypothesis, member); });
}

/// Some sets of labels that cost least and are not known, each in at most so many variants.
std::vector<Search::Proposal> Search::nearest(std::vector<Proposal> proposals, std::size_t count, int most_variants) const {
  std::ranges::stable_sort(proposals, {}, &Proposal::cost);
  std::map<std::set<std::string>, int> times;
  std::vector<Proposal> result;
  std::size_t set_count = 0;
  for (Proposal& proposal : proposals) {
    if (isKnown(proposal)) continue;
    int& time = times[causes_.labelsOf(proposal.start.members)];
    if (time >= most_variants || (time == 0 && set_count >= count)) continue;
    set_count += time == 0 ? 1 : 0;
    ++time;
    result.push_back(std::move(proposal));
  }
  return result;
}

/// The nearest proposals, and the nearest whose last effect is of each stage: faults of sensors resemble a little of everything, and would
/// fill the list alone.
std::vector<Search::Proposal> Search::nearestOfStages(const std::vector<Proposal>& all, std::size_t count, std::size_t per_stage,
                                                      int most_variants) const {
  std::vector<Proposal> result = nearest(all, count, most_variants);
  for (const Stage stage : {Stage::command, Stage::pressure, Stage::force, Stage::body, Stage::sensor}) {
    std::vector<Proposal> of_stage;
    for (const Proposal& proposal : all)
      if (causes_.hypotheses[proposal.start.members.back()].info().stage == stage) of_stage.push_back(proposal);
    for (Proposal& proposal : nearest(std::move(of_stage), per_stage, most_variants))
      if (std::ranges::none_of(result, [&](const Proposal& other) { return other.start.members == proposal.start.members; }))
        result.push_back(std::move(proposal));
  }
  return result;
}

/// The nearest, some of each stage, and the nearest of each kind of effect: a linear estimate about no effect is rough, and what resembles
/// the best of all would fill the list alone.
std::vector<Search::Proposal> Search::singleEffects(const Surroundings& around) const {
  const auto idOf = [this](const Proposal& proposal) { return causes_.hypotheses[proposal.start.members.back()].info().id; };
  std::vector<Proposal> all;
  for (std::size_t i = 0; i < around.of_hypothesis.size(); ++i)
    if (!around.of_hypothesis[i].empty()) all.push_back(proposed(around, {i}));
  std::vector<Proposal> result = nearestOfStages(all, single_count, per_stage_count, 2);
  std::ranges::stable_sort(all, {}, &Proposal::cost);
  std::set<std::string> ids;
  for (const Proposal& proposal : result) ids.insert(idOf(proposal));
  for (Proposal& proposal : all)
    if (ids.insert(idOf(proposal)).second) result.push_back(std::move(proposal));
  return result;
}

/// The best sets of two and more effects of the linear model, by a beam search.
std::vector<Search::Proposal> Search::largerSets(const Surroundings& around) const {
  std::vector<Proposal> result;
  std::vector<std::vector<std::size_t>> level = {{}};
  for (int size = 1; size <= options_.max_effects; ++size) {
    std::vector<std::vector<std::size_t>> sets;
    std::set<std::set<std::size_t>> seen;
    for (const auto& members : level)
      for (std::size_t i = 0; i < around.of_hypothesis.size(); ++i) {
        if (around.of_hypothesis[i].empty() || !fitsBeside(i, members)) continue;
        std::vector<std::size_t> larger = members;
        larger.push_back(i);
        if (seen.insert({larger.begin(), larger.end()}).second) sets.push_back(std::move(larger));
      }
    std::vector<Proposal> proposals = proposedEach(around, sets);
    std::ranges::stable_sort(proposals, {}, &Proposal::cost);
    if (proposals.size() > beam_width) proposals.resize(beam_width);
    level.clear();
    for (const Proposal& proposal : proposals) level.push_back(proposal.start.members);
    if (size >= 2)
      for (Proposal& proposal : nearest(std::move(proposals), size == 2 ? 2 : 1)) result.push_back(std::move(proposal));
  }
  return result;
}

std::vector<Search::Proposal> Search::additions(const Surroundings& around) const {
  const std::vector<std::size_t>& members = around.base.members;
  std::vector<Proposal> result;
  if (static_cast<int>(members.size()) < options_.max_effects)
    for (std::size_t i = 0; i < around.of_hypothesis.size(); ++i)
      if (!around.of_hypothesis[i].empty()) result.push_back(proposed(around, {i}));
  return result;
}

std::vector<Search::Proposal> Search::drops(const Surroundings& around) const {
  const std::vector<std::size_t>& members = around.base.members;
  std::vector<Proposal> result;
  for (std::size_t m = 0; m < members.size() && members.size() > 1; ++m) result.push_back(proposed(around, {}, m));
  return result;
}

/// Moves a start that diverges, or costs more than no effect at all, towards its origin.
void Search::nearToOrigin(Proposal& proposal) const {
  constexpr double share = 0.3;
  constexpr int most_moves = 3;
  const double without = screening_.misfit(screening_residual_);
  Explanation &start = proposal.start, &origin = proposal.origin;
  start.z = causes_.clamped(start.members, start.z);
  start.numbers = plant_.clampedNumbers(start.numbers);
  if (origin.members.empty()) {
    origin = start;
    const Hypothesis& last = causes_.hypotheses[start.members.back()];
    for (const int strength : last.strengths()) origin.z.tail(last.coordinateCount())[strength] = 0;
  }
  for (int k = 0; k < most_moves; ++k) {
    const double misfit = screening_.misfit(screening_.residualOf(causes_.modelOf(start)));
    on_simulation_();
    if (misfit < without) break;
    start.z = causes_.clamped(start.members, origin.z + share * (start.z - origin.z));
    start.numbers = plant_.clampedNumbers(origin.numbers + share * (start.numbers - origin.numbers));
  }
}

/// Fits proposals to the screening segments. The fit of a set of two and more effects ends early where nothing better is promised than what
/// would not be extended.
void Search::fitOnScreening(std::vector<Proposal> proposals) {
  const std::vector<std::size_t> best = bestOnScreening(0, 1);
  parallelFor(static_cast<int>(proposals.size()), options_.job_count, [&](int i) {
    Proposal& proposal = proposals[static_cast<std::size_t>(i)];
    Explanation& start = proposal.start;
    if (plant_.interrupted()) return;
    nearToOrigin(proposal);
    const bool is_base = best.empty() || start.members.size() < 2;  // what is extended in any case
    const double least_score = is_base ? -std::numeric_limits<double>::infinity() : pool_[best.front()].score - hopeless - promise_error;
    causes_.refit(start, screening_, screening_rounds, Fidelity::coarse, Accuracy::ranking, std::move(proposal.known), Known::elsewhere,
                  screeningEvidence().largestCost(start, least_score));
    if (start.residual.size() == screening_.size()) start.score = screeningEvidence().score(start);
  });
  for (Proposal& proposal : proposals) {
    Explanation& fitted = proposal.start;
    if (fitted.residual.size() != screening_.size()) continue;
    fitted.jacobian.resize(0, 0);
    const auto same = sameAmong(pool_, fitted);
    if (same == pool_.end())
      pool_.push_back(std::move(fitted));
    else if (fitted.score > same->score)
      *same = std::move(fitted);
  }
}

void Search::expand(const Explanation& base) {
  if (!expanded_.insert(causes_.labelsOf(base.members)).second || plant_.interrupted()) return;
  const Explanation copy = base;  // the pool grows below
  const Surroundings around = surroundingsOf(copy, {neighbour_count, 1});
  std::vector<Proposal> proposals = nearestOfStages(additions(around), addition_count, 1, 1);
  // Further lags may have taken in a part of what an added dead time makes, so that a fit of both ends between the two.
  for (std::size_t i = 0, count = proposals.size(); i < count; ++i)
    if (Explanation simple = causes_.withoutFurtherMechanisms(proposals[i].start); simple.members != proposals[i].start.members)
      proposals.push_back({std::move(simple), proposals[i].cost});
  std::ranges::move(nearest(drops(around), drop_count), std::back_inserter(proposals));
  fitOnScreening(std::move(proposals));
}

/// Indices of the best explanations of one size (0: of any).
std::vector<std::size_t> Search::bestOnScreening(std::size_t member_count, std::size_t count) const {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < pool_.size(); ++i)
    if (member_count == 0 ? !pool_[i].members.empty() : pool_[i].members.size() == member_count) order.push_back(i);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return pool_[a].score > pool_[b].score; });
  if (order.size() > count) order.resize(count);
  return order;
}

/// Some of the best explanations of one size, none of which leaves nearly the same as a better one, or consists of the same effects on
/// other components: what resembles each other would be extended by the same effects.
std::vector<std::size_t> Search::unlikeOnScreening(std::size_t member_count, std::size_t count) const {
  constexpr double alike = 0.9;  // correlation of two residuals
  const auto idsOf = [this](const Explanation& explanation) {
    std::multiset<std::string> ids;
    for (const std::size_t member : explanation.members) ids.insert(causes_.hypotheses[member].info().id);
    return ids;
  };
  std::vector<std::size_t> chosen;
  for (const std::size_t index : bestOnScreening(member_count, pool_.size())) {
    if (chosen.size() == count) break;
    const bool is_new = std::ranges::none_of(chosen, [&](std::size_t better) {
      if (idsOf(pool_[better]) == idsOf(pool_[index])) return true;
      const Eigen::VectorXd weights = screening_.weights(pool_[better].residual);
      const Eigen::VectorXd one = weights.cwiseProduct(pool_[index].residual), other = weights.cwiseProduct(pool_[better].residual);
      return one.dot(other) > alike * one.norm() * other.norm();
    });
    if (is_new) chosen.push_back(index);
  }
  return chosen;
}

std::vector<Explanation> Search::singles() const {
  std::vector<Explanation> result;
  for (const std::size_t index : bestOnScreening(1, pool_.size())) result.push_back(pool_[index]);
  return result;
}

/// Index of the candidate, one of the variants of an effect, that comes nearest to it, and its coordinates there. Throws BadParameter if
/// there is none.
Causes::Part Search::nearestTo(const ActiveEffect& effect) const {
  const std::string label = effect.id + "@" + effect.component;
  std::optional<Causes::Part> nearest;
  int fewest = 0;
  for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i) {
    if (causes_.hypotheses[i].label() != label || !catalogue_.allowed[i]) continue;
    const auto [z, others] = causes_.hypotheses[i].nearestTo(effect);
    if (nearest && others >= fewest) continue;
    nearest = Causes::Part{i, z};
    fewest = others;
  }
  if (nearest) return *nearest;
  throw BadParameter("--effects", label, "be a candidate that these recordings can show; --fixed-effects takes any effect");
}

/// DiagnosisOptions::earlier as the start of a fit.
Explanation Search::earlierFinding() const {
  std::vector<Causes::Part> parts;
  for (const ActiveEffect& effect : options_.earlier) parts.push_back(nearestTo(effect));
  return Causes::assembled(parts, nothing_.numbers);
}

/// Widens and expands the best explanations of each size, from one effect on.
void Search::extendBySize() {
  for (int size = 1; size <= options_.max_effects && !plant_.interrupted(); ++size) {
    const auto of_size = static_cast<std::size_t>(size);
    std::vector<Proposal> wide;
    for (const std::size_t index : bestOnScreening(of_size, wide_count))
      std::ranges::move(nearest(widened(pool_[index]), wide_count, 2), std::back_inserter(wide));
    fitOnScreening(std::move(wide));
    const std::vector<std::size_t> best = bestOnScreening(0, 1), bases = unlikeOnScreening(of_size, base_counts[of_size - 1]);
    for (const std::size_t index : bases)
      if (size == 1 || pool_[index].score > pool_[best.front()].score - hopeless) expand(pool_[index]);
  }
}

/// Whether an effect changes a signal in focus by a noticeable part of its noise.
bool Search::changesFocus(std::size_t hypothesis) const {
  constexpr double noticeable = 0.3;  // noise floors
  return std::ranges::any_of(catalogue_.sensitivities[hypothesis].per_strength, [&](const SharedVector& change) {
    return change && std::ranges::any_of(screening_.blocks(), [&](const Comparison::Block& block) {
             return block.power > 0 && std::sqrt(screening_.meanSquare(block, *change)) > noticeable * block.sigma;
           });
  });
}

/// The sets that explain the measured pressures alone best. What happens behind the pressures does not disturb them, so that the causes in
/// front of them can be told there while those behind them are not yet known.
std::vector<Explanation> Search::explainPressures() {
  constexpr std::size_t kept = 2;
  constexpr double too_small = 1;  // nats: less than a parameter costs
  screening_.focusOn(Focus::pressures);
  if (screening_.misfit(screening_residual_) < too_small) {
    screening_.focusOn(Focus::all_signals);
    return {};
  }
  const std::vector<char> allowed = catalogue_.allowed;
  for (std::size_t i = 0; i < allowed.size(); ++i)
    if (!changesFocus(i)) catalogue_.allowed[i] = false;
  about_nothing_.clear();
  about_nothing_.push_back(surroundingsOf(nothing_, catalogue_.sensitivities));
  fitOnScreening(singleEffects(about_nothing_.front()));
  extendBySize();
  std::vector<Explanation> found;
  for (const std::size_t index : bestOnScreening(0, kept))
    if (pool_[index].score > screeningEvidence().score(nothing_)) found.push_back(pool_[index]);
  pool_.clear();
  expanded_.clear();
  catalogue_.allowed = allowed;
  screening_.focusOn(Focus::all_signals);
  return found;
}

void Search::decide() {
  nothing_.numbers = plant_.numbersInForce();
  nothing_.residual = screening_residual_;
  const std::vector<Explanation> of_pressures = explainPressures();
  about_nothing_ = surroundingsOfNothing();
  std::vector<Proposal> proposals;
  for (const Surroundings& around : about_nothing_) {
    std::ranges::move(singleEffects(around), std::back_inserter(proposals));
    std::ranges::move(largerSets(around), std::back_inserter(proposals));
  }
  for (const Explanation& one : of_pressures) proposals.push_back({one, 0});
  if (!options_.earlier.empty()) proposals.push_back({earlierFinding(), 0});
  fitOnScreening(std::move(proposals));
  for (const Explanation& one : of_pressures) {
    const auto fitted = std::ranges::find(pool_, one.members, &Explanation::members);
    if (fitted != pool_.end()) expand(*fitted);
  }
  extendBySize();
  if (!plant_.leavesOut(MethodPart::stand_ins)) tryStandIns();
  fitFinalists();
}

/// Uses the steps of derivatives().
Rival Search::rival(const Explanation& explanation, const std::string& label) const {
  Rival result{label, causes_.modelOf(explanation), explanation.probability, {}, {}};
  const FitProblem problem = causes_.problemOf(explanation, fit_, Fidelity::coarse);
  const Eigen::MatrixXd slopes = fit_.weights(explanation.residual).asDiagonal() * derivatives(fit_, problem, problem.start);
  std::vector<Eigen::Index> moving;
  for (Eigen::Index k = 0; k < problem.start.size(); ++k)
    if (stepOf(problem, problem.start, k) != 0) moving.push_back(k);
  result.slopes.resize(slopes.rows(), static_cast<Eigen::Index>(moving.size()));
  for (std::size_t i = 0; i < moving.size(); ++i) {
    Eigen::VectorXd z = problem.start;
    const double step = stepOf(problem, z, moving[i]);
    z[moving[i]] += step;
    Explanation moved = explanation;
    moved.z = z.head(explanation.z.size());
    moved.numbers = z.tail(explanation.numbers.size());
    result.beside.push_back(causes_.modelOf(moved));
    result.slopes.col(static_cast<Eigen::Index>(i)) = step * slopes.col(moving[i]);
  }
  return result;
}

}  // namespace musclesim
