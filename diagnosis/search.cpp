#include "search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>

#include "../base/parallel.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t single_count = 9;     ///< single effects that are fitted
constexpr std::size_t per_stage_count = 2;  ///< and at least so many of every stage
constexpr std::size_t beside_count = 30;   ///< effects that are simulated beside an explanation
constexpr std::size_t beam_width = 5;       ///< sets of each size that the linear search keeps
constexpr std::size_t addition_count = 4, swap_count = 4;  ///< sets that are fitted about one explanation
constexpr std::size_t base_counts[] = {3, 2, 2, 1, 1, 1};  ///< explanations of each size that are extended
constexpr double hopeless = 4;      ///< nats behind the best: sets of this size are not extended any more
constexpr double far_behind = 8;    ///< nats behind the best on the screening segments: not fitted to all recordings
constexpr std::size_t finalist_count = 10;
constexpr std::size_t varied_count = 2;  ///< explanations of which other variants are tried
constexpr int screening_rounds = 4, coarse_rounds = 4, fine_rounds = 3;
constexpr double usual_strength = 3;   ///< standard deviation of strengths in the linear model, in typical strengths
constexpr double largest_change = 3;   ///< the same for coordinates of an explanation that is changed

}  // namespace

Search::Search(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation)
    : plant_(plant),
      options_(options),
      on_simulation_(std::move(on_simulation)),
      causes_(plant, on_simulation_),
      screening_(plant, plant.screeningSegments(), Comparison::Averages::with),
      fit_(plant, plant.split().fit, Comparison::Averages::with) {}

bool Search::isKnown(const std::vector<std::size_t>& members) const {
  const std::set<std::string> labels = causes_.labelsOf(members);
  return std::ranges::any_of(pool_, [&](const Explanation& known) { return causes_.labelsOf(known.members) == labels; });
}

bool Search::fitsBeside(std::size_t hypothesis, const std::vector<std::size_t>& members) const {
  return catalogue_.allowed[hypothesis] &&
         std::ranges::none_of(members, [&](std::size_t member) { return causes_.clash(hypothesis, member); });
}

/// Simulates every hypothesis beside the base and every change of the base itself.
Search::Surroundings Search::surroundingsOf(const Explanation& base) const {
  const FitProblem problem = causes_.problemOf(base, screening_, Fidelity::coarse);
  const Eigen::VectorXd residual = base.residual, predicted = screening_.measured() - residual;
  std::vector<LinearModel::Column> columns;
  const auto add = [&](Eigen::VectorXd change, double least, double most, double precision, double start) {
    columns.push_back({std::move(change), least, most, precision, start});
    return columns.size() - 1;
  };
  std::vector<std::vector<std::size_t>> of_hypothesis(causes_.hypotheses.size()), of_member(base.members.size());
  std::vector<std::size_t> removals, of_numbers;
  // The base itself.
  const Eigen::MatrixXd slopes = derivatives(screening_, problem, problem.start);
  std::vector<Eigen::VectorXd> by_coordinate;
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) by_coordinate.push_back(slopes.col(k));
  for (std::size_t m = 0; m < base.members.size(); ++m) {
    const Eigen::Index first = causes_.firstCoordinate(base, m);
    const int count = causes_.hypotheses[base.members[m]].coordinateCount();
    for (Eigen::Index k = first; k < first + count; ++k)
      of_member[m].push_back(add(slopes.col(k), -largest_change, largest_change, 1 / (usual_strength * usual_strength), 0));
    Explanation without = base;
    without.members.erase(without.members.begin() + static_cast<std::ptrdiff_t>(m));
    without.z.resize(base.z.size() - count);
    without.z << base.z.head(first), base.z.tail(base.z.size() - first - count);
    const Eigen::VectorXd left = screening_.predicted(causes_.modelOf(without));
    on_simulation_();
    removals.push_back(add(left.size() ? Eigen::VectorXd(left - predicted) : Eigen::VectorXd::Zero(predicted.size()), 1, 1, 0, 0));
  }
  for (Eigen::Index k = 0; k < plant_.numberCount(); ++k)
    of_numbers.push_back(add(slopes.col(base.z.size() + k), -largest_change, largest_change, 1, base.numbers[k]));
  // The others beside it.
  std::vector<Sensitivity> sensitivities = catalogue_.sensitivities;
  if (!base.members.empty()) changesBeside(base, predicted, sensitivities);
  for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i) {
    const Hypothesis& hypothesis = causes_.hypotheses[i];
    const auto& changes = sensitivities[i].per_strength;
    if (!fitsBeside(i, base.members) ||
        std::ranges::any_of(changes, [&](const Eigen::VectorXd& change) { return change.size() != predicted.size(); }))
      continue;
    for (std::size_t k = 0; k < changes.size(); ++k) {
      const bool is_fixed = hypothesis.strengths().empty();  // present or absent
      const bool is_signed = !is_fixed && hypothesis.isSigned(hypothesis.strengths()[k]);
      of_hypothesis[i].push_back(add(changes[k], is_fixed ? 1 : is_signed ? -largest_amount : 0, is_fixed ? 1 : largest_amount,
                                     is_fixed ? 0 : 1 / (usual_strength * usual_strength), 0));
    }
  }
  return {base,          LinearModel(screening_, residual, std::move(columns)), std::move(of_hypothesis), std::move(of_member),
          std::move(removals), std::move(of_numbers), std::move(sensitivities), std::move(by_coordinate)};
}

/// The hypotheses that may be added to the base with most gain by the linear model about no effect, the nearest variant of each label, and
/// some of each stage.
std::vector<std::size_t> Search::worthAdding(const Explanation& base) const {
  std::vector<std::pair<double, std::size_t>> costs;
  for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i)
    if (!about_nothing_->of_hypothesis[i].empty() && fitsBeside(i, base.members)) costs.emplace_back(0, i);
  parallelFor(static_cast<int>(costs.size()), options_.job_count, [&](int k) {
    auto& [cost, index] = costs[static_cast<std::size_t>(k)];
    std::vector<std::size_t> members = base.members;
    members.push_back(index);
    cost = proposed(*about_nothing_, {}, members).cost;
  });
  std::ranges::stable_sort(costs, {}, &std::pair<double, std::size_t>::first);
  std::set<std::string> labels;
  std::map<Stage, std::size_t> per_stage;
  std::vector<std::size_t> result;
  for (const auto& [cost, index] : costs) {
    const Hypothesis& hypothesis = causes_.hypotheses[index];
    if (labels.contains(hypothesis.label()) || (result.size() >= beside_count && per_stage[hypothesis.info().stage] >= per_stage_count))
      continue;
    labels.insert(hypothesis.label());
    ++per_stage[hypothesis.info().stage];
    result.push_back(index);
  }
  return result;
}

/// Simulates the hypotheses worth adding beside the base; the others get no changes.
void Search::changesBeside(const Explanation& base, const Eigen::VectorXd& predicted, std::vector<Sensitivity>& sensitivities) const {
  const std::vector<std::size_t> indices = worthAdding(base);
  std::vector<Hypothesis> others;
  for (const std::size_t i : indices) others.push_back(causes_.hypotheses[i]);
  std::vector<Sensitivity> beside =
      changesOf(screening_, others, predicted, causes_.modelOf(base), options_.job_count, on_simulation_);
  for (Sensitivity& sensitivity : sensitivities) std::ranges::fill(sensitivity.per_strength, Eigen::VectorXd());
  for (std::size_t k = 0; k < indices.size(); ++k) sensitivities[indices[k]].per_strength = std::move(beside[k].per_strength);
}

/// The set of some members of the base, by their positions, and further hypotheses.
Search::Proposal Search::proposed(const Surroundings& around, const std::vector<std::size_t>& kept,
                                  const std::vector<std::size_t>& added) const {
  const Explanation& base = around.base;
  std::vector<std::size_t> columns = around.of_numbers;
  for (std::size_t m = 0; m < base.members.size(); ++m) {
    if (std::ranges::find(kept, m) == kept.end())
      columns.push_back(around.removal_of_member[m]);
    else
      std::ranges::copy(around.of_member[m], std::back_inserter(columns));
  }
  for (const std::size_t hypothesis : added) std::ranges::copy(around.of_hypothesis[hypothesis], std::back_inserter(columns));
  const LinearModel::Solution solution = around.model.solve(columns);
  std::map<std::size_t, double> amounts;
  for (std::size_t i = 0; i < columns.size(); ++i) amounts[columns[i]] = solution.amounts[static_cast<Eigen::Index>(i)];
  Proposal proposal;
  Explanation& start = proposal.start;
  std::vector<double> z;
  for (const std::size_t m : kept) {
    start.members.push_back(base.members[m]);
    const Eigen::Index first = causes_.firstCoordinate(base, m);
    for (std::size_t k = 0; k < around.of_member[m].size(); ++k) {
      const Eigen::Index coordinate = first + static_cast<Eigen::Index>(k);
      z.push_back(base.z[coordinate] + amounts[around.of_member[m][k]]);
      proposal.known.push_back(around.derivatives[static_cast<std::size_t>(coordinate)]);
    }
  }
  for (const std::size_t index : added) {
    start.members.push_back(index);
    const Hypothesis& hypothesis = causes_.hypotheses[index];
    std::vector<double> own(static_cast<std::size_t>(hypothesis.coordinateCount()), 0);
    for (std::size_t k = 0; k < hypothesis.strengths().size(); ++k) {
      constexpr double least = 0.05;
      const double amount = amounts[around.of_hypothesis[index][k]];
      own[static_cast<std::size_t>(hypothesis.strengths()[k])] =
          around.sensitivities[index].from_threshold ? 1 : std::abs(amount) < least ? least : amount;
    }
    std::ranges::copy(own, std::back_inserter(z));
    for (std::size_t k = 0; k < own.size(); ++k) proposal.known.emplace_back();
  }
  start.z = Eigen::Map<const Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()));
  start.numbers = base.numbers;
  for (std::size_t k = 0; k < around.of_numbers.size(); ++k) {
    start.numbers[static_cast<Eigen::Index>(k)] += amounts[around.of_numbers[k]];
    proposal.known.push_back(around.derivatives[static_cast<std::size_t>(base.z.size()) + k]);
  }
  proposal.cost = solution.cost + screeningEvidence().price(start);
  return proposal;
}

/// The proposals that cost least and are not known, each set of labels at most twice (two variants).
std::vector<Search::Proposal> Search::nearest(std::vector<Proposal> proposals, std::size_t count, int most_variants) const {
  std::ranges::stable_sort(proposals, {}, &Proposal::cost);
  std::map<std::set<std::string>, int> times;
  std::vector<Proposal> result;
  std::size_t set_count = 0;
  for (Proposal& proposal : proposals) {
    if (isKnown(proposal.start.members)) continue;
    int& time = times[causes_.labelsOf(proposal.start.members)];
    if (time >= most_variants || (time == 0 && set_count >= count)) continue;
    set_count += time == 0 ? 1 : 0;
    ++time;
    result.push_back(std::move(proposal));
  }
  return result;
}

std::vector<Search::Proposal> Search::singleEffects(const Surroundings& around) const {
  std::vector<Proposal> all;
  for (std::size_t i = 0; i < around.of_hypothesis.size(); ++i)
    if (!around.of_hypothesis[i].empty()) all.push_back(proposed(around, {}, {i}));
  std::vector<Proposal> result = nearest(all, single_count, 2);
  for (const Stage stage : {Stage::command, Stage::pressure, Stage::force, Stage::body, Stage::sensor}) {
    std::vector<Proposal> of_stage;
    for (const Proposal& proposal : all)
      if (causes_.hypotheses[proposal.start.members.front()].info().stage == stage) of_stage.push_back(proposal);
    for (Proposal& proposal : nearest(std::move(of_stage), per_stage_count, 2))
      if (std::ranges::none_of(result, [&](const Proposal& other) { return other.start.members == proposal.start.members; }))
        result.push_back(std::move(proposal));
  }
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
    std::vector<Proposal> proposals(sets.size());
    parallelFor(static_cast<int>(sets.size()), options_.job_count, [&](int i) {
      const auto index = static_cast<std::size_t>(i);
      proposals[index] = proposed(around, {}, sets[index]);
    });
    std::ranges::stable_sort(proposals, {}, &Proposal::cost);
    if (proposals.size() > beam_width) proposals.resize(beam_width);
    level.clear();
    for (const Proposal& proposal : proposals) level.push_back(proposal.start.members);
    if (size >= 2)
      for (Proposal& proposal : nearest(std::move(proposals), size == 2 ? 2 : 1)) result.push_back(std::move(proposal));
  }
  return result;
}

namespace {

/// 0, 1, ... count - 1 without one of them.
std::vector<std::size_t> allBut(std::size_t left_out, std::size_t count) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < count; ++i)
    if (i != left_out) result.push_back(i);
  return result;
}

}  // namespace

std::vector<Search::Proposal> Search::additions(const Surroundings& around) const {
  const std::vector<std::size_t>& members = around.base.members;
  std::vector<Proposal> result;
  if (static_cast<int>(members.size()) < options_.max_effects)
    for (std::size_t i = 0; i < around.of_hypothesis.size(); ++i)
      if (!around.of_hypothesis[i].empty()) result.push_back(proposed(around, allBut(members.size(), members.size()), {i}));
  return result;
}

std::vector<Search::Proposal> Search::swaps(const Surroundings& around) const {
  const std::vector<std::size_t>& members = around.base.members;
  std::vector<Proposal> result;
  if (members.size() < 2) return result;
  for (std::size_t m = 0; m < members.size(); ++m)
    for (std::size_t i = 0; i < around.of_hypothesis.size(); ++i)
      if (!around.of_hypothesis[i].empty()) result.push_back(proposed(around, allBut(m, members.size()), {i}));
  return result;
}

std::vector<Search::Proposal> Search::drops(const Surroundings& around) const {
  const std::vector<std::size_t>& members = around.base.members;
  std::vector<Proposal> result;
  for (std::size_t m = 0; m < members.size() && members.size() > 1; ++m)
    result.push_back(proposed(around, allBut(m, members.size()), {}));
  return result;
}

/// Fits proposals to the screening segments. A start that costs more than without its last effect is weakened first.
void Search::fitOnScreening(std::vector<Proposal> proposals) {
  const double without = screening_.misfit(screening_residual_);
  parallelFor(static_cast<int>(proposals.size()), options_.job_count, [&](int i) {
    constexpr double share = 0.3;
    constexpr int weakenings = 3;
    Proposal& proposal = proposals[static_cast<std::size_t>(i)];
    Explanation& start = proposal.start;
    if (plant_.interrupted()) return;
    const Hypothesis& last = causes_.hypotheses[start.members.back()];
    start.z = causes_.clamped(start.members, start.z);
    for (int k = 0; k < weakenings; ++k) {
      const Eigen::VectorXd predicted = screening_.predicted(causes_.modelOf(start));
      on_simulation_();
      if (predicted.size() == screening_.size() && screening_.misfit(screening_.measured() - predicted) < without) break;
      for (const int strength : last.strengths()) start.z.tail(last.coordinateCount())[strength] *= share;
    }
    causes_.refit(start, screening_, screening_rounds, Fidelity::coarse, std::move(proposal.known));
    if (start.residual.size() == screening_.size()) start.score = screeningEvidence().score(start);
  });
  for (Proposal& proposal : proposals) {
    Explanation& fitted = proposal.start;
    if (fitted.residual.size() != screening_.size()) continue;
    fitted.jacobian.resize(0, 0);
    const std::set<std::string> labels = causes_.labelsOf(fitted.members);
    const auto same = std::ranges::find_if(pool_, [&](const Explanation& other) { return causes_.labelsOf(other.members) == labels; });
    if (same == pool_.end())
      pool_.push_back(std::move(fitted));
    else if (fitted.score > same->score)
      *same = std::move(fitted);
  }
}

void Search::expand(const Explanation& base) {
  if (!expanded_.insert(causes_.labelsOf(base.members)).second || plant_.interrupted()) return;
  const Explanation copy = base;  // the pool grows below
  const Surroundings around = surroundingsOf(copy);
  std::vector<Proposal> proposals = nearest(additions(around), addition_count);
  std::ranges::move(nearest(swaps(around), swap_count), std::back_inserter(proposals));
  std::ranges::move(nearest(drops(around), swap_count), std::back_inserter(proposals));
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

std::vector<Explanation> Search::singles() const {
  std::vector<Explanation> result;
  for (const std::size_t index : bestOnScreening(1, pool_.size())) result.push_back(pool_[index]);
  return result;
}

void Search::decide() {
  auto dbg=[&](const char* w){ if(getenv("DBG")) fprintf(stderr,"%s sims %ld pool %zu best %.2f\n",w,plant_.simulationCount(),pool_.size(), pool_.empty()?0.0:pool_[bestOnScreening(0,1).front()].score); };
  dbg("screened");
  nothing_.numbers = Eigen::VectorXd::Zero(plant_.numberCount());
  nothing_.residual = screening_residual_;
  about_nothing_ = std::make_unique<Surroundings>(surroundingsOf(nothing_));
  std::vector<Proposal> proposals = singleEffects(*about_nothing_);
  std::ranges::move(largerSets(*about_nothing_), std::back_inserter(proposals));
  dbg("nothing");
  if (!options_.earlier.empty()) proposals.push_back({earlierFinding(), 0});
  fitOnScreening(std::move(proposals));
  dbg("singles and linear");
  for (int size = 1; size <= options_.max_effects && !plant_.interrupted(); ++size) {
    const auto of_size = static_cast<std::size_t>(size);
    const std::vector<std::size_t> best = bestOnScreening(0, 1), bases = bestOnScreening(of_size, base_counts[of_size - 1]);
    for (const std::size_t index : bases)
      if (size == 1 || pool_[index].score > pool_[best.front()].score - hopeless) expand(pool_[index]);
    dbg("level");
  }
  for (int further = 0; further < 2 && !plant_.interrupted(); ++further)
    for (const std::size_t index : bestOnScreening(0, 1)) expand(pool_[index]);
  dbg("further");
  if (getenv("DBG")) for (auto i : bestOnScreening(0, 30)) { std::string t; for (auto& l : causes_.labelsOf(pool_[i].members)) t += l + " "; fprintf(stderr, "   %.2f misfit %.2f %s\n", pool_[i].score, screening_.misfit(pool_[i].residual), t.c_str()); }
  fitFinalists();
  dbg("finalists");
}

/// Whether a part of its effects does clearly better alone.
bool Search::isDominated(const Explanation& explanation) const {
  constexpr double clearly = 2;  // nats
  const std::set<std::string> labels = causes_.labelsOf(explanation.members);
  return std::ranges::any_of(pool_, [&](const Explanation& other) {
    return other.members.size() < explanation.members.size() && other.score > explanation.score + clearly &&
           std::ranges::includes(labels, causes_.labelsOf(other.members));
  });
}

/// DiagnosisOptions::earlier as the start of a fit.
Explanation Search::earlierFinding() const {
  Explanation result;
  std::vector<double> z;
  for (const ActiveEffect& effect : options_.earlier) {
    const std::string label = effect.id + "@" + effect.component;
    const auto found = std::ranges::find(causes_.hypotheses, label, &Hypothesis::label);
    if (found == causes_.hypotheses.end())
      throw BadParameter("--effects", label, "be an effect that these recordings can show; --fixed-effects takes any");
    result.members.push_back(static_cast<std::size_t>(found - causes_.hypotheses.begin()));
    const Eigen::VectorXd own = found->coordinatesOf(effect.parameters);
    z.insert(z.end(), own.begin(), own.end());
  }
  result.z = Eigen::Map<const Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()));
  result.numbers = nothing_.numbers;
  return result;
}

/// The same effects with another variant of one of them: the search fits one variant only.
std::vector<Explanation> Search::otherVariants(const Explanation& explanation) const {
  std::vector<Explanation> result;
  const Model model = causes_.modelOf(explanation);
  for (std::size_t m = 0; m < explanation.members.size(); ++m)
    for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i) {
      if (i == explanation.members[m] || causes_.hypotheses[i].label() != causes_.hypotheses[explanation.members[m]].label()) continue;
      const Eigen::Index first = causes_.firstCoordinate(explanation, m);
      const Eigen::Index after = first + causes_.hypotheses[explanation.members[m]].coordinateCount();
      const Eigen::VectorXd own = causes_.hypotheses[i].coordinatesOf(model.effects[m].parameters);
      Explanation other = explanation;
      other.members[m] = i;
      other.z.resize(explanation.z.size() - (after - first) + own.size());
      other.z << explanation.z.head(first), own, explanation.z.tail(explanation.z.size() - after);
      other.half_width.resize(0);
      result.push_back(std::move(other));
    }
  return result;
}

/// Fits the likely explanations, and no effect, to all recordings in fine steps and weighs them.
void Search::fitFinalists() {
  std::vector<std::size_t> best = bestOnScreening(0, pool_.size());
  std::erase_if(best, [&](std::size_t index) {
    return pool_[index].score < pool_[best.front()].score - far_behind || isDominated(pool_[index]);
  });
  if (best.size() > finalist_count) best.resize(finalist_count);
  for (const std::size_t index : best) explanations_.push_back(pool_[index]);
  explanations_.push_back(nothing_);
  parallelFor(static_cast<int>(explanations_.size()), options_.job_count, [&](int i) {
    if (!plant_.interrupted()) fitToAll(explanations_[static_cast<std::size_t>(i)]);
  });
  std::erase_if(explanations_, [&](const Explanation& explanation) { return explanation.residual.size() != fit_.size(); });
  std::ranges::stable_sort(explanations_, std::greater<>{}, &Explanation::score);
  tryVariants();
  weigh();
}

/// Replaces the best explanations by other variants of themselves that are better.
void Search::tryVariants() {
  for (std::size_t rank = 0; rank < std::min(explanations_.size(), varied_count); ++rank) {
    std::vector<Explanation> others = otherVariants(explanations_[rank]);
    parallelFor(static_cast<int>(others.size()), options_.job_count, [&](int i) {
      if (!plant_.interrupted()) fitToAll(others[static_cast<std::size_t>(i)]);
    });
    for (Explanation& other : others)
      if (other.residual.size() == fit_.size() && other.score > explanations_[rank].score) explanations_[rank] = std::move(other);
  }
}

/// Coarse steps first; the derivatives found there serve for fine ones too.
void Search::fitToAll(Explanation& explanation) const {
  causes_.refit(explanation, fit_, coarse_rounds, Fidelity::coarse);
  if (explanation.residual.size() != fit_.size()) return;
  std::vector<Eigen::VectorXd> known;
  for (Eigen::Index k = 0; k < explanation.jacobian.cols(); ++k) known.emplace_back(explanation.jacobian.col(k));
  causes_.refit(explanation, fit_, fine_rounds, Fidelity::fine, std::move(known));
  if (explanation.residual.size() != fit_.size()) return;
  takeFromCounterparts(explanation);
  explanation.is_inactive = hasInactiveEffect(explanation);
  explanation.score = evidence().score(explanation);
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
  causes_.refit(changed, fit_, 0, Fidelity::fine);
  if (changed.residual.size() != fit_.size() || fit_.misfit(changed.residual) > fit_.misfit(explanation.residual) + noticeable) return;
  changed.jacobian = explanation.jacobian;
  explanation = changed;
}

/// True if an effect's strength can go to nearly zero at no noticeable loss: its shape parameters explain the data, not the effect. For
/// example a leak without a leak is the lag of its regulator.
bool Search::hasInactiveEffect(const Explanation& explanation) const {
  constexpr double next_to_nothing = 1e-3, noticeable = 0.45;  // typical strengths; nats
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
          fit_.misfit(explanation.residual + as_it_is - predicted) < fit_.misfit(explanation.residual) + noticeable)
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
  none_of_these_ = 1 / (1 + std::exp(-evidence().ofSomethingElse(explanations_)));
  std::ranges::stable_sort(explanations_, std::greater<>{}, &Explanation::probability);
  const auto nothing = std::ranges::find_if(explanations_, [](const Explanation& explanation) { return explanation.members.empty(); });
  if (nothing != explanations_.end()) {
    nothing_ = *nothing;
    explanations_.erase(nothing);
  }
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
