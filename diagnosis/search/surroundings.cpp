// The linear model about one explanation: its columns, and what it proposes.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "../../base/parallel.h"
#include "search.h"

namespace musclesim {

namespace {

constexpr std::size_t beside_per_stage_count = 2;  ///< effects of every stage that are simulated beside an explanation at least
constexpr double strength_precision = 1.0 / 9;     ///< of a normal prior: three typical strengths are usual
constexpr double largest_change = 3;               ///< of a coordinate or a number, up to which the prediction is taken as linear

}  // namespace

/// Columns of the base's own coordinates, of the removal of each effect, and of the numbers.
void Search::addOwnColumns(Surroundings& around, std::vector<LinearModel::Column>& columns) const {
  const Explanation& base = around.base;
  const Eigen::VectorXd predicted = screening_.measured() - base.residual;
  const FitProblem problem = causes_.problemOf(base, screening_, Fidelity::coarse);
  const Eigen::MatrixXd slopes = derivatives(screening_, problem, problem.start);
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) around.derivatives.push_back(std::make_shared<const Eigen::VectorXd>(slopes.col(k)));
  std::vector<SharedVector> removals(base.members.size());
  parallelFor(static_cast<int>(removals.size()), options_.job_count, [&](int m) {
    const auto index = static_cast<std::size_t>(m);
    const Eigen::VectorXd left = screening_.predicted(causes_.modelOf(causes_.without(base, index)));
    on_simulation_();
    removals[index] = shared(left.size() ? Eigen::VectorXd(left - predicted) : Eigen::VectorXd::Zero(predicted.size()));
  });
  for (std::size_t m = 0; m < base.members.size(); ++m) {
    const Eigen::Index first = causes_.firstCoordinate(base, m);
    const int count = causes_.hypotheses[base.members[m]].coordinateCount();
    auto& own = around.of_member.emplace_back();
    for (Eigen::Index k = first; k < first + count; ++k) {
      own.push_back(columns.size());
      columns.push_back({around.derivatives[static_cast<std::size_t>(k)], -largest_change, largest_change, strength_precision});
    }
    around.removal_of_member.push_back(columns.size());
    columns.push_back({removals[m], 1, 1, 0});
  }
  for (Eigen::Index k = 0; k < plant_.numberCount(); ++k) {
    around.of_numbers.push_back(columns.size());
    columns.push_back(
        {around.derivatives[static_cast<std::size_t>(base.z.size() + k)], -largest_change, largest_change, 1, base.numbers[k]});
  }
}

/// Columns of the hypotheses that may be added.
void Search::addOtherColumns(Surroundings& around, std::vector<LinearModel::Column>& columns) const {
  around.of_hypothesis.resize(causes_.hypotheses.size());
  for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i) {
    const Hypothesis& hypothesis = causes_.hypotheses[i];
    const auto& changes = around.sensitivities[i].per_strength;
    const auto is_unknown = [](const SharedVector& change) { return !change; };
    if (!fitsBeside(i, around.base.members) || std::ranges::any_of(changes, is_unknown)) continue;
    for (std::size_t k = 0; k < changes.size(); ++k) {
      around.of_hypothesis[i].push_back(columns.size());
      if (hypothesis.strengths().empty())  // present or absent
        columns.push_back({changes[k], 1, 1, 0});
      else
        columns.push_back(
            {changes[k], hypothesis.isSigned(hypothesis.strengths()[k]) ? -largest_amount : 0, largest_amount, strength_precision});
    }
  }
}

/// Adds to a base with its own columns those of the hypotheses, and makes the linear model.
Search::Surroundings Search::completed(Surroundings around, std::vector<LinearModel::Column> columns,
                                       std::vector<Sensitivity> sensitivities) const {
  around.sensitivities = std::move(sensitivities);
  addOtherColumns(around, columns);
  around.model.emplace(screening_, around.base.residual, std::move(columns));
  return around;
}

/// Simulates every change of the base itself, and of the hypotheses beside it those worth it.
Search::Surroundings Search::surroundingsOf(const Explanation& base, const Neighbours& neighbours) const {
  Surroundings around{base, {}, {}, {}, {}, {}, {}, {}};
  std::vector<LinearModel::Column> columns;
  addOwnColumns(around, columns);
  std::vector<Sensitivity> beside = changesBeside(base, worthSimulatingBeside(around, columns, neighbours));
  return completed(std::move(around), std::move(columns), std::move(beside));
}

/// Simulates every change of the base itself; those of the hypotheses are known.
Search::Surroundings Search::surroundingsOf(const Explanation& base, std::vector<Sensitivity> sensitivities) const {
  Surroundings around{base, {}, {}, {}, {}, {}, {}, {}};
  std::vector<LinearModel::Column> columns;
  addOwnColumns(around, columns);
  return completed(std::move(around), std::move(columns), std::move(sensitivities));
}

/// The surroundings of the model without effects. A fit of numbers without effects explains by them what effects make: for a forearm whose
/// joint has a spring it finds nearly twice the mass. Therefore the search begins at the values that the user gave, too.
std::vector<Search::Surroundings> Search::surroundingsOfNothing() const {
  std::vector<Surroundings> result;
  result.push_back(surroundingsOf(nothing_, catalogue_.sensitivities));
  if (nothing_.numbers.isZero(0)) return result;
  Explanation as_given = nothing_;
  as_given.numbers.setZero();
  as_given.residual = screening_.residualOf(causes_.modelOf(as_given));
  on_simulation_();
  if (!as_given.residual.size() || plant_.interrupted()) return result;
  result.push_back(surroundingsOf(as_given, changesBeside(as_given, screenedBeside(as_given))));
  return result;
}

/// All screened hypotheses that may act beside the base.
std::vector<std::size_t> Search::screenedBeside(const Explanation& base) const {
  const auto is_known = [](const SharedVector& change) { return change != nullptr; };
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i)
    if (fitsBeside(i, base.members) && std::ranges::all_of(catalogue_.sensitivities[i].per_strength, is_known)) result.push_back(i);
  return result;
}

/// about_nothing_ has one or two entries. Returns the one whose numbers are nearest to those of the base.
const Search::Surroundings& Search::aboutNothingNear(const Explanation& base) const {
  return *std::ranges::min_element(about_nothing_, {},
                                   [&](const Surroundings& around) { return (around.base.numbers - base.numbers).squaredNorm(); });
}

/// All pairs of one effect on two components, in the same variant, that can be added together. Example: where both muscles of a joint
/// creep, one of them alone explains little, because the joint then moves by their difference.
std::vector<std::vector<std::size_t>> Search::twins(const Surroundings& around) const {
  std::vector<std::vector<std::size_t>> result;
  if (static_cast<int>(around.base.members.size()) + 2 > options_.max_effects) return result;
  for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i)
    for (std::size_t k = i + 1; k < causes_.hypotheses.size(); ++k) {
      const Hypothesis &one = causes_.hypotheses[i], &other = causes_.hypotheses[k];
      if (one.info().id == other.info().id && one.strengthNames() == other.strengthNames() &&
          one.coordinateCount() == other.coordinateCount() && !causes_.clash(i, k) && !around.of_hypothesis[i].empty() &&
          !around.of_hypothesis[k].empty())
        result.push_back({i, k});
    }
  return result;
}

/// What every hypothesis costs if it is added to the members of the base, alone or with its twin on another component, whichever is less;
/// infinity if it cannot be added.
std::vector<double> Search::costsOfAddingWithTwin(const Surroundings& around) const {
  std::vector<double> costs = costsOfAdding(around);
  const std::vector<std::vector<std::size_t>> pairs = twins(around);
  const std::vector<Proposal> of_pairs = proposedEach(around, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (const std::size_t one : pairs[i]) costs[one] = std::min(costs[one], of_pairs[i].cost);
  return costs;
}

/// What every hypothesis costs if it is added to the members of the base; infinity if it cannot be added.
std::vector<double> Search::costsOfAdding(const Surroundings& around) const {
  std::vector<double> costs(causes_.hypotheses.size(), std::numeric_limits<double>::infinity());
  parallelFor(static_cast<int>(costs.size()), options_.job_count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    if (!around.of_hypothesis[index].empty()) costs[index] = proposed(around, {index}).cost;
  });
  return costs;
}

/// The hypotheses that can be added, in ascending order of their costs.
std::vector<std::size_t> Search::inOrderOf(const std::vector<double>& costs) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < costs.size(); ++i)
    if (std::isfinite(costs[i])) order.push_back(i);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return costs[i]; });
  return order;
}

/// Hypotheses that were not screened (there are too many components), but may act beside the base: in one of the places, or as the effect
/// of a member on another component.
std::vector<std::size_t> Search::unscreenedBeside(const Explanation& base, const std::vector<std::string>& places) const {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < causes_.hypotheses.size(); ++i) {
    const Hypothesis& hypothesis = causes_.hypotheses[i];
    const auto is_unknown = [](const SharedVector& change) { return !change; };
    if (std::ranges::none_of(catalogue_.sensitivities[i].per_strength, is_unknown) || !fitsBeside(i, base.members)) continue;
    const bool is_effect_of_member =
        std::ranges::any_of(base.members, [&](std::size_t member) { return causes_.hypotheses[member].info().id == hypothesis.info().id; });
    if (std::ranges::find(places, hypothesis.place()) != places.end() || is_effect_of_member) result.push_back(i);
  }
  return result;
}

/// Chooses the hypotheses that are simulated beside the base: the ones that cost least if they are added, and some of each stage. `around`
/// and `columns` hold the base's own columns; what each hypothesis changes is taken from simulations without effects, and from the known
/// ones beside an explanation that is near, whichever promises more.
std::vector<std::size_t> Search::worthSimulatingBeside(const Surroundings& around, const std::vector<LinearModel::Column>& columns,
                                                       const Neighbours& neighbours) const {
  const auto costsWith = [&](const std::vector<Sensitivity>& sensitivities) {
    return costsOfAddingWithTwin(completed(around, columns, sensitivities));
  };
  std::vector<double> costs = costsWith(aboutNothingNear(around.base).sensitivities);
  if (neighbours.beside_near)
    std::ranges::transform(costs, costsWith(*neighbours.beside_near), costs.begin(),
                           [](double one, double other) { return std::min(one, other); });
  std::map<std::string, int> variants_of_label;
  std::map<Stage, std::size_t> per_stage;
  std::vector<std::size_t> result;
  for (const std::size_t index : inOrderOf(costs)) {
    const Hypothesis& hypothesis = causes_.hypotheses[index];
    std::size_t& of_stage = per_stage[hypothesis.info().stage];
    int& chosen = variants_of_label[hypothesis.label()];
    const bool is_left_out = std::ranges::find(neighbours.places, hypothesis.place()) == neighbours.places.end() &&
                             variants_of_label.size() > neighbours.count && of_stage >= beside_per_stage_count;
    if (chosen == 0 && is_left_out) chosen = neighbours.variants;  // its other variants are left out, too
    if (chosen >= neighbours.variants) continue;
    of_stage += chosen == 0 ? 1 : 0;
    ++chosen;
    result.push_back(index);
  }
  for (const std::size_t index : unscreenedBeside(around.base, neighbours.places))
    if (variants_of_label[causes_.hypotheses[index].label()]++ < neighbours.variants) result.push_back(index);
  return result;
}

/// Sensitivities beside the base of some hypotheses; the others get no changes.
std::vector<Sensitivity> Search::changesBeside(const Explanation& base, const std::vector<std::size_t>& indices) const {
  std::vector<Hypothesis> others;
  for (const std::size_t i : indices) others.push_back(causes_.hypotheses[i]);
  std::vector<Sensitivity> beside =
      changesOf(screening_, others, screening_.measured() - base.residual, causes_.modelOf(base), options_.job_count, on_simulation_);
  std::vector<Sensitivity> all(causes_.hypotheses.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].per_strength.resize(catalogue_.sensitivities[i].per_strength.size());
    all[i].from_threshold = catalogue_.sensitivities[i].from_threshold;
  }
  for (std::size_t k = 0; k < indices.size(); ++k) all[indices[k]].per_strength = std::move(beside[k].per_strength);
  return all;
}

/// The start of a fit of the members of the base, without one of them if it is to be removed, and of further hypotheses; its cost by the
/// linear model.
Search::Proposal Search::proposed(const Surroundings& around, const std::vector<std::size_t>& added,
                                  std::optional<std::size_t> removed) const {
  const Explanation& base = around.base;
  std::vector<std::size_t> columns = around.of_numbers;
  for (std::size_t m = 0; m < base.members.size(); ++m) {
    if (m == removed)
      columns.push_back(around.removal_of_member[m]);
    else
      std::ranges::copy(around.of_member[m], std::back_inserter(columns));
  }
  for (const std::size_t hypothesis : added) std::ranges::copy(around.of_hypothesis[hypothesis], std::back_inserter(columns));
  const LinearModel::Solution solution = around.model->solve(columns);
  std::map<std::size_t, double> amounts;
  for (std::size_t i = 0; i < columns.size(); ++i) amounts[columns[i]] = solution.amounts[static_cast<Eigen::Index>(i)];
  Proposal proposal;
  std::vector<double> z, origin;
  for (std::size_t m = 0; m < base.members.size(); ++m) {
    if (m == removed) continue;
    proposal.start.members.push_back(base.members[m]);
    for (std::size_t k = 0; k < around.of_member[m].size(); ++k) {
      const Eigen::Index coordinate = causes_.firstCoordinate(base, m) + static_cast<Eigen::Index>(k);
      z.push_back(base.z[coordinate] + amounts[around.of_member[m][k]]);
      origin.push_back(base.z[coordinate]);
      proposal.known.push_back(around.derivatives[static_cast<std::size_t>(coordinate)]);
    }
  }
  for (const std::size_t index : added) {
    proposal.start.members.push_back(index);
    std::vector<double> found;
    for (const std::size_t column : around.of_hypothesis[index]) found.push_back(amounts[column]);
    const Eigen::VectorXd own = startOf(causes_.hypotheses[index], around.sensitivities[index], found);
    z.insert(z.end(), own.begin(), own.end());
    Eigen::VectorXd without_strength = own;
    for (const int strength : causes_.hypotheses[index].strengths()) without_strength[strength] = 0;
    origin.insert(origin.end(), without_strength.begin(), without_strength.end());
    proposal.known.resize(proposal.known.size() + static_cast<std::size_t>(own.size()));
  }
  proposal.start.z = Eigen::Map<const Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()));
  proposal.start.numbers = base.numbers;
  proposal.origin = proposal.start;
  proposal.origin.z = Eigen::Map<const Eigen::VectorXd>(origin.data(), static_cast<Eigen::Index>(origin.size()));
  for (std::size_t k = 0; k < around.of_numbers.size(); ++k) {
    proposal.start.numbers[static_cast<Eigen::Index>(k)] += amounts[around.of_numbers[k]];
    proposal.known.push_back(around.derivatives[static_cast<std::size_t>(base.z.size()) + k]);
  }
  proposal.cost = solution.cost + screeningEvidence().price(proposal.start);
  return proposal;
}

/// One proposal for each set of further hypotheses.
std::vector<Search::Proposal> Search::proposedEach(const Surroundings& around, const std::vector<std::vector<std::size_t>>& added) const {
  std::vector<Proposal> result(added.size());
  parallelFor(static_cast<int>(added.size()), options_.job_count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    result[index] = proposed(around, added[index]);
  });
  return result;
}

}  // namespace musclesim
