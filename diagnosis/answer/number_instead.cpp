#include "number_instead.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

#include "../../base/parallel.h"
#include "verdict.h"

namespace musclesim {

namespace {

constexpr double promising = 0.5;              ///< largest share of the excess that a step may leave by linear models, if that is more than
                                               ///< allowed; they are rough where dry friction holds
const double step = std::log(1.02);            ///< of ln(number / given value), for derivatives
const double farthest = std::log(1.3);         ///< nobody takes a number for exact that is further off
constexpr int check_count = 3;                 ///< simulated steps towards the value of a number
constexpr std::size_t numbers_per_effect = 3;  ///< that are told

/// A number that was taken as exact, and what its logarithm changes in the prediction.
struct ExactNumber {
  Parameter parameter;
  Eigen::VectorXd slope;

  double given() const { return std::get<double>(parameter.value); }
  double at(double logarithm) const { return std::clamp(given() * std::exp(logarithm), parameter.minimum, parameter.maximum); }
  /// The derivative's step: upward, or downward where the range ends.
  double step() const { return at(musclesim::step) != given() * std::exp(musclesim::step) ? -musclesim::step : musclesim::step; }
};

/// The chosen explanation with some effects taken away and everything else fitted anew, with or without a number that may take their place.
class Replacement {
 public:
  /// `members`: positions of the effects that are taken away, in order.
  Replacement(const Search& search, const std::vector<std::size_t>& members, const Eigen::VectorXd& predicted,
              const OnSimulation& on_simulation)
      : search_(search),
        comparison_(search.fitComparison()),
        chosen_(search.explanations().front()),
        predicted_(predicted),
        on_simulation_(on_simulation) {
    rest_ = chosen_;
    std::vector<Eigen::Index> kept;
    for (std::size_t m = 0; m < chosen_.members.size(); ++m) {
      const Eigen::Index first = search.causes().firstCoordinate(chosen_, m);
      const int count = search.hypotheses()[chosen_.members[m]].coordinateCount();
      for (int k = 0; k < count && std::ranges::find(members, m) == members.end(); ++k) kept.push_back(first + k);
    }
    for (Eigen::Index k = 0; k < chosen_.numbers.size(); ++k) kept.push_back(chosen_.z.size() + k);
    for (auto member = members.rbegin(); member != members.rend(); ++member) rest_ = search.causes().without(rest_, *member);
    columns_ = chosen_.jacobian(Eigen::all, kept);
    without_ = residualOf(search.modelOf(rest_));
    // A number costs one parameter; the effects that it replaces cost more.
    const Evidence evidence = search.evidence();
    allowed_ = clearly + std::max(0.0, evidence.price(chosen_) - evidence.price(rest_) - prices.parameters);
  }

  /// Whether the rest does as well by itself; then the effects say nothing that a number could say.
  bool isNeedless() const { return !without_.size() || fitted(nullptr).has_value(); }
  /// The logarithm of the number over its given value at which the rest does as well as the whole; none if there is no such value.
  std::optional<double> instead(const ExactNumber& number) const { return fitted(&number); }

 private:
  /// In the steps of the comparison, corrected to the fine steps in which the chosen explanation was fitted. Empty if it diverges.
  Eigen::VectorXd residualOf(const Model& model) const {
    if (comparison_.plant().interrupted()) return {};
    on_simulation_();
    const Eigen::VectorXd predicted = comparison_.predicted(model);
    if (predicted.size() != predicted_.size()) return {};
    return chosen_.residual + predicted_ - predicted;
  }

  double costOf(const Eigen::VectorXd& residual, const Eigen::VectorXd& numbers) const {
    return comparison_.misfit(residual) + costOfNumbers(numbers);
  }

  /// Gauss-Newton steps with the derivatives of the whole, each simulated. The rows below those of the residual are the numbers' prior.
  std::optional<double> fitted(const ExactNumber* number) const {
    const Eigen::Index effects = rest_.z.size(), numbers = rest_.numbers.size(), rows = comparison_.size();
    const Eigen::Index column_count = effects + numbers + (number ? 1 : 0);
    if (column_count == 0) return std::nullopt;  // nothing is left to be fitted
    Eigen::MatrixXd columns(rows, column_count);
    columns.leftCols(effects + numbers) = columns_;
    if (number) columns.col(column_count - 1) = number->slope;
    const Eigen::VectorXd weights = comparison_.weights(chosen_.residual);
    Eigen::MatrixXd weighted = Eigen::MatrixXd::Zero(rows + numbers, column_count);
    weighted.topRows(rows) = weights.asDiagonal() * columns;
    weighted.block(rows, effects, numbers, numbers).setIdentity();
    const auto solver = weighted.completeOrthogonalDecomposition();

    const double least = costOf(chosen_.residual, chosen_.numbers);
    Explanation moved = rest_;
    Eigen::VectorXd residual = without_;
    double logarithm = 0;
    if (number) {  // first the number alone: what the others gain without it, where the effects are missing, may lead away
      const Eigen::VectorXd slope = weights.cwiseProduct(number->slope);
      const double amount = slope.dot(weights.cwiseProduct(residual)) / slope.squaredNorm();
      Eigen::VectorXd alone = std::abs(amount) > farthest ? Eigen::VectorXd() : residualOf(modelOf(moved, number, amount));
      if (alone.size() && comparison_.misfit(alone) < comparison_.misfit(residual)) {
        residual = std::move(alone);
        logarithm = amount;
      }
    }
    double best = logarithm, best_excess = std::numeric_limits<double>::infinity();
    for (int check = 0;; ++check) {
      const double excess = residual.size() ? costOf(residual, moved.numbers) - least : best_excess;
      if (excess < best_excess) {
        best = logarithm;
        best_excess = excess;
      } else if (check > 0) {
        break;
      }
      if (check == check_count) break;
      Eigen::VectorXd target(rows + numbers);
      target << weights.cwiseProduct(residual), -moved.numbers;
      const Eigen::VectorXd change = solver.solve(target);
      const double hoped = costOf(residual - columns * change, moved.numbers + change.segment(effects, numbers)) - least;
      if (hoped > allowed_ && hoped > promising * excess) break;
      moved.z = search_.causes().clamped(moved.members, moved.z + change.head(effects));
      moved.numbers = comparison_.plant().clampedNumbers(moved.numbers + change.segment(effects, numbers));
      if (number) logarithm += change[column_count - 1];
      if (std::abs(logarithm) > farthest) break;
      residual = residualOf(modelOf(moved, number, logarithm));
    }
    return best_excess <= allowed_ ? std::optional(best) : std::nullopt;
  }

  Model modelOf(const Explanation& explanation, const ExactNumber* number, double logarithm) const {
    Model model = search_.modelOf(explanation);
    if (number) model.parameters.emplace_back(number->parameter.name, number->at(logarithm));
    return model;
  }

  const Search& search_;
  const Comparison& comparison_;
  const Explanation& chosen_;
  const Eigen::VectorXd& predicted_;  ///< by the chosen explanation, in the steps of the comparison
  const OnSimulation& on_simulation_;
  Explanation rest_;         ///< the chosen one without the effects
  Eigen::MatrixXd columns_;  ///< derivatives of the prediction by the coordinates and numbers of the rest
  Eigen::VectorXd without_;  ///< residual of the rest as it is
  double allowed_ = 0;       ///< nats that the rest may cost more, price of effects and number aside
};

/// The numbers that change anything beside the chosen explanation.
std::vector<ExactNumber> exactNumbers(const Search& search, const Eigen::VectorXd& predicted, const OnSimulation& on_simulation) {
  const Comparison& comparison = search.fitComparison();
  std::vector<ExactNumber> numbers;
  for (Parameter& parameter : comparison.plant().exactNumbers()) numbers.push_back({std::move(parameter), {}});
  const Model model = search.modelOf(search.explanations().front());
  parallelFor(static_cast<int>(numbers.size()), comparison.plant().jobCount(), [&](int i) {
    if (comparison.plant().interrupted()) return;
    ExactNumber& number = numbers[static_cast<std::size_t>(i)];
    Model changed = model;
    changed.parameters.emplace_back(number.parameter.name, number.at(number.step()));
    const Eigen::VectorXd moved = comparison.predicted(changed);
    on_simulation();
    if (moved.size() == predicted.size()) number.slope = (moved - predicted) / number.step();
  });
  std::erase_if(numbers, [](const ExactNumber& number) { return !number.slope.size() || number.slope.isZero(0); });
  return numbers;
}

}  // namespace

std::vector<NumberInstead> numbersInstead(const Search& search, const OnSimulation& on_simulation) {
  if (search.explanations().empty()) return {};
  const Comparison& comparison = search.fitComparison();
  const Explanation& chosen = search.explanations().front();
  const Eigen::VectorXd predicted = comparison.predicted(search.modelOf(chosen));
  if (!predicted.size() || chosen.residual.size() != comparison.size() || chosen.jacobian.rows() != comparison.size()) return {};
  const std::vector<ExactNumber> numbers = exactNumbers(search, predicted, on_simulation);
  if (numbers.empty()) return {};

  struct Found {
    std::size_t number;
    double logarithm;
    std::vector<std::size_t> members;
  };
  const auto replacing = [&](const std::vector<std::size_t>& members, const std::vector<std::size_t>& tried) {
    std::vector<Found> found;
    const Replacement replacement(search, members, predicted, on_simulation);
    if (comparison.plant().interrupted() || replacement.isNeedless()) return found;
    std::vector<std::optional<double>> logarithms(tried.size());
    parallelFor(static_cast<int>(tried.size()), comparison.plant().jobCount(),
                [&](int i) { logarithms[static_cast<std::size_t>(i)] = replacement.instead(numbers[tried[static_cast<std::size_t>(i)]]); });
    for (std::size_t i = 0; i < tried.size(); ++i)
      if (logarithms[i]) found.push_back({tried[i], *logarithms[i], members});
    std::ranges::stable_sort(found, {}, [](const Found& one) { return std::abs(one.logarithm); });
    if (found.size() > numbers_per_effect) found.resize(numbers_per_effect);
    return found;
  };
  std::vector<std::size_t> all(numbers.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<Found> found;
  for (std::size_t m = 0; m < chosen.members.size(); ++m) std::ranges::move(replacing({m}, all), std::back_inserter(found));
  // A number that can take the place of several effects, each by itself, may take that of all.
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::vector<std::size_t> members;
    for (const Found& one : found)
      if (one.number == i) members.push_back(one.members.front());
    if (members.size() < 2) continue;
    std::vector<Found> together = replacing(members, {i});
    if (together.empty()) continue;
    std::erase_if(found, [&](const Found& one) { return one.number == i; });
    found.insert(found.begin(), together.front());
  }
  std::vector<NumberInstead> result;
  for (const Found& one : found) {
    const ExactNumber& number = numbers[one.number];
    NumberInstead& told =
        result.emplace_back(NumberInstead{number.parameter.name, number.parameter.unit, number.given(), number.at(one.logarithm), {}});
    for (const std::size_t m : one.members) told.effects.push_back(search.hypotheses()[chosen.members[m]].label());
  }
  return result;
}

}  // namespace musclesim
