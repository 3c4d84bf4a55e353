#include "number_instead.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "../../base/parallel.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double as_well_nats = 2.5;           ///< behind the chosen explanation; the verdict's bound for what does nearly as well
constexpr double promising = 0.5;              ///< largest share of the misfit without the effect that a step may leave by linear models,
                                               ///< which are rough where dry friction holds
const double step = std::log(1.02);            ///< of ln(number / given value), for derivatives
const double farthest = std::log(1.3);         ///< nobody takes a number for exact that is further off
constexpr int check_count = 3;                 ///< simulated steps towards the value of a number
constexpr std::size_t numbers_per_effect = 3;  ///< that are told

/// A number of the robot's own description that has no tolerance, and what its logarithm changes in the prediction.
struct ExactNumber {
  Parameter parameter;
  Eigen::VectorXd slope;

  double given() const { return std::get<double>(parameter.value); }
  double at(double logarithm) const { return std::clamp(given() * std::exp(logarithm), parameter.minimum, parameter.maximum); }
};

class Replacement {
 public:
  Replacement(const Search& search, int job_count, const OnSimulation& on_simulation)
      : search_(search),
        comparison_(search.fitComparison()),
        chosen_(search.explanations().front()),
        job_count_(job_count),
        on_simulation_(on_simulation),
        predicted_(predictedBy(search.modelOf(chosen_))) {}

  std::vector<NumberInstead> found() const {
    std::vector<NumberInstead> result;
    if (!predicted_.size() || chosen_.jacobian.rows() != comparison_.size()) return result;
    const std::vector<ExactNumber> numbers = exactNumbers();
    if (numbers.empty()) return result;
    for (std::size_t m = 0; m < chosen_.members.size() && !comparison_.plant().interrupted(); ++m) {
      const Explanation rest = search_.causes().without(chosen_, m);
      const Eigen::VectorXd without = predictedBy(search_.modelOf(rest));
      if (!without.size()) continue;
      std::vector<std::optional<double>> logarithms(numbers.size());
      parallelFor(static_cast<int>(numbers.size()), job_count_, [&](int i) {
        const auto index = static_cast<std::size_t>(i);
        logarithms[index] = instead(numbers[index], m, rest, without);
      });
      std::vector<std::size_t> order;
      for (std::size_t i = 0; i < numbers.size(); ++i)
        if (logarithms[i]) order.push_back(i);
      std::ranges::stable_sort(order, {}, [&](std::size_t i) { return std::abs(*logarithms[i]); });
      if (order.size() > numbers_per_effect) order.resize(numbers_per_effect);
      for (const std::size_t i : order)
        result.push_back({numbers[i].parameter.name, numbers[i].parameter.unit, numbers[i].given(), numbers[i].at(*logarithms[i]),
                          search_.hypotheses()[chosen_.members[m]].label()});
    }
    return result;
  }

 private:
  /// Empty if the model diverges or cannot be built.
  Eigen::VectorXd predictedBy(const Model& model) const {
    if (comparison_.plant().interrupted()) return {};
    on_simulation_();
    try {
      return comparison_.predicted(model);
    } catch (const BadParameter&) {
      return {};
    } catch (const BadFile&) {
      return {};
    }
  }

  static Model with(Model model, const ExactNumber& number, double logarithm) {
    model.parameters.emplace_back(number.parameter.name, number.at(logarithm));
    return model;
  }

  std::vector<ExactNumber> exactNumbers() const {
    const Plant& plant = comparison_.plant();
    const std::string group = plant.model().robot().name() + ".";
    std::vector<ExactNumber> numbers;
    for (const Parameter& parameter : plant.model().parameters().declared()) {
      const bool is_number = std::holds_alternative<double>(parameter.value) && !parameter.integer;
      const bool is_uncertain =
          std::ranges::any_of(plant.numbers(), [&](const UncertainNumber& one) { return one.parameter.name == parameter.name; });
      if (is_number && !is_uncertain && parameter.name.starts_with(group) && std::get<double>(parameter.value) != 0)
        numbers.push_back({parameter, {}});
    }
    const Model model = search_.modelOf(chosen_);
    parallelFor(static_cast<int>(numbers.size()), job_count_, [&](int i) {
      ExactNumber& number = numbers[static_cast<std::size_t>(i)];
      const Eigen::VectorXd moved = predictedBy(with(model, number, step));
      if (moved.size() == predicted_.size()) number.slope = (moved - predicted_) / step;
    });
    std::erase_if(numbers, [](const ExactNumber& number) { return !number.slope.size() || number.slope.isZero(0); });
    return numbers;
  }

  /// The logarithm of the number over its given value at which `rest`, fitted anew, does as well as the whole; none if there is no such
  /// value. `without` is the prediction of the rest as it is. Gauss-Newton steps with the derivatives of the whole, each simulated.
  std::optional<double> instead(const ExactNumber& number, std::size_t member, const Explanation& rest,
                                const Eigen::VectorXd& without) const {
    const Eigen::Index first = search_.causes().firstCoordinate(chosen_, member);
    const Eigen::Index count = search_.hypotheses()[chosen_.members[member]].coordinateCount();
    const Eigen::Index before = first, after = chosen_.jacobian.cols() - first - count;
    Eigen::MatrixXd columns(comparison_.size(), before + after + 1);
    columns << chosen_.jacobian.leftCols(before), chosen_.jacobian.rightCols(after), number.slope;
    const Eigen::VectorXd whole = comparison_.measured() - predicted_, weights = comparison_.weights(whole);
    const auto solver = (weights.asDiagonal() * columns).eval().completeOrthogonalDecomposition();
    const double least = comparison_.misfit(whole);
    Explanation moved = rest;
    double logarithm = 0;
    Eigen::VectorXd residual = comparison_.measured() - without;
    for (int check = 0; check < check_count; ++check) {
      const Eigen::VectorXd change = solver.solve(weights.cwiseProduct(residual));
      const double hoped = comparison_.misfit(residual - columns * change), now = comparison_.misfit(residual);
      if (hoped - least > promising * (now - least)) return std::nullopt;
      moved.z = search_.causes().clamped(moved.members, moved.z + change.head(moved.z.size()));
      moved.numbers += change.segment(moved.z.size(), moved.numbers.size());
      logarithm += change[change.size() - 1];
      if (std::abs(logarithm) > farthest) return std::nullopt;
      const Eigen::VectorXd predicted = predictedBy(with(search_.modelOf(moved), number, logarithm));
      if (predicted.size() != comparison_.size()) return std::nullopt;
      residual = comparison_.measured() - predicted;
      if (comparison_.misfit(residual) <= least + as_well_nats) return logarithm;
    }
    return std::nullopt;
  }

  const Search& search_;
  const Comparison& comparison_;
  const Explanation& chosen_;
  int job_count_;
  const OnSimulation& on_simulation_;
  Eigen::VectorXd predicted_;
};

}  // namespace

std::vector<NumberInstead> numbersInstead(const Search& search, int job_count, const OnSimulation& on_simulation) {
  if (search.explanations().empty()) return {};
  return Replacement(search, job_count, on_simulation).found();
}

}  // namespace musclesim
