#include "explanation.h"

#include <algorithm>

namespace musclesim {

void setCertainty(Explanation& explanation, const Certainty& certainty) {
  const Eigen::Index count = certainty.half_width.size() ? explanation.z.size() : 0;
  explanation.half_width = certainty.half_width.head(count);
  explanation.determined = certainty.determined.head(count);
  explanation.numbers_half_width = certainty.half_width.tail(certainty.half_width.size() - count);
}

namespace {

constexpr double roughly_enough = 0.02, roughly_valid = 0.2;  ///< nats: for fits that only rank explanations

void take(Explanation& explanation, const FitResult& result, bool is_certainty_new) {
  const Eigen::Index effect_count = explanation.z.size();
  explanation.z = result.z.head(effect_count);
  explanation.numbers = result.z.tail(result.z.size() - effect_count);
  if (is_certainty_new) setCertainty(explanation, result.certainty);
  explanation.residual = result.residual;
  explanation.jacobian = result.jacobian;
}

}  // namespace

bool overlap(const std::string& one, const std::string& other) {
  if (one == "all" || other == "all") return true;
  // A pair of muscles, "muscle_0+muscle_1", overlaps with either.
  const std::string in_one = "+" + one + "+", in_other = "+" + other + "+";
  return in_one.find(in_other) != std::string::npos || in_other.find(in_one) != std::string::npos;
}

std::vector<Causes::Part> Causes::partsOf(const Explanation& explanation) const {
  std::vector<Part> parts;
  Eigen::Index first = 0;
  for (const std::size_t hypothesis : explanation.members) {
    const Eigen::Index count = hypotheses[hypothesis].coordinateCount();
    parts.push_back({hypothesis, explanation.z.segment(first, count)});
    first += count;
  }
  return parts;
}

Explanation Causes::assembled(const std::vector<Part>& parts, const Eigen::VectorXd& numbers) {
  Explanation result;
  std::vector<double> z;
  for (const auto& [hypothesis, own] : parts) {
    result.members.push_back(hypothesis);
    z.insert(z.end(), own.begin(), own.end());
  }
  result.z = Eigen::Map<const Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()));
  result.numbers = numbers;
  return result;
}

Model Causes::modelOf(const Explanation& explanation) const {
  Model model;
  for (const auto& [hypothesis, own] : partsOf(explanation)) model.effects.push_back(hypotheses[hypothesis].at(own));
  model.parameters = plant_.numbersAt(explanation.numbers);
  return model;
}

std::set<std::string> Causes::labelsOf(const std::vector<std::size_t>& members) const {
  std::set<std::string> labels;
  for (const std::size_t member : members) labels.insert(hypotheses[member].label());
  return labels;
}

bool Causes::clash(std::size_t one, std::size_t other) const {
  return hypotheses[one].info().id == hypotheses[other].info().id && overlap(hypotheses[one].component(), hypotheses[other].component());
}

Eigen::Index Causes::firstCoordinate(const Explanation& explanation, std::size_t member) const {
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < member; ++i) first += hypotheses[explanation.members[i]].coordinateCount();
  return first;
}

Explanation Causes::without(const Explanation& explanation, std::size_t member) const {
  std::vector<Part> parts = partsOf(explanation);
  parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(member));
  return assembled(parts, explanation.numbers);
}

Explanation Causes::with(const Explanation& explanation, std::size_t hypothesis,
                         const std::map<std::string, Parameter::Value>& values) const {
  std::vector<Part> parts = partsOf(explanation);
  parts.push_back({hypothesis, hypotheses[hypothesis].coordinatesOf(values)});
  return assembled(parts, explanation.numbers);
}

Explanation Causes::takingOver(const Explanation& explanation, const Explanation& other) const {
  std::vector<Part> parts = partsOf(explanation);
  for (const Part& of_other : partsOf(other))
    for (Part& part : parts)
      if (hypotheses[part.hypothesis].label() == hypotheses[of_other.hypothesis].label()) part = of_other;
  return assembled(parts, other.numbers);
}

Explanation Causes::inVariants(const Explanation& explanation,
                               const std::function<bool(const Hypothesis& own, const Hypothesis& other)>& isWanted) const {
  const Model model = modelOf(explanation);
  std::vector<Part> parts;
  for (std::size_t m = 0; m < explanation.members.size(); ++m) {
    const Hypothesis& own = hypotheses[explanation.members[m]];
    const auto wanted =
        std::ranges::find_if(hypotheses, [&](const Hypothesis& other) { return other.label() == own.label() && isWanted(own, other); });
    const std::size_t variant = wanted == hypotheses.end() ? explanation.members[m] : static_cast<std::size_t>(wanted - hypotheses.begin());
    parts.push_back({variant, hypotheses[variant].coordinatesOf(model.effects[m].parameters)});
  }
  return assembled(parts, explanation.numbers);
}

Explanation Causes::withFurtherMechanisms(const Explanation& explanation) const {
  return inVariants(explanation, [](const Hypothesis& own, const Hypothesis& other) {
    const auto more = static_cast<int>(other.furtherMechanisms().size());
    return own.furtherMechanisms().empty() && more > 0 && other.coordinateCount() == own.coordinateCount() + more;
  });
}

Explanation Causes::withoutFurtherMechanisms(const Explanation& explanation) const {
  return inVariants(explanation, [](const Hypothesis& own, const Hypothesis& other) {
    const auto more = static_cast<int>(own.furtherMechanisms().size());
    return more > 0 && other.furtherMechanisms().empty() && other.coordinateCount() == own.coordinateCount() - more;
  });
}

Eigen::VectorXd Causes::clamped(const std::vector<std::size_t>& members, const Eigen::VectorXd& z) const {
  Eigen::VectorXd result = z;
  Eigen::Index first = 0;
  for (const std::size_t index : members) {
    const Eigen::Index count = hypotheses[index].coordinateCount();
    result.segment(first, count) = hypotheses[index].clamped(z.segment(first, count));
    first += count;
  }
  return result;
}

FitProblem Causes::problemOf(const Explanation& explanation, const Comparison& comparison, Fidelity fidelity) const {
  const Eigen::Index effect_count = explanation.z.size(), number_count = plant_.numberCount();
  FitProblem problem;
  problem.start.resize(effect_count + number_count);
  problem.start << explanation.z, explanation.numbers;
  problem.precision = Eigen::VectorXd::Zero(effect_count + number_count);
  problem.precision.tail(number_count).setOnes();
  problem.clamped = [this, members = explanation.members, effect_count, number_count](const Eigen::VectorXd& z) {
    Eigen::VectorXd result(z.size());
    result << clamped(members, z.head(effect_count)), plant_.clampedNumbers(z.tail(number_count));
    return result;
  };
  problem.predicted = [this, members = explanation.members, effect_count, number_count, &comparison, fidelity](const Eigen::VectorXd& z) {
    on_simulation_();
    Explanation at;
    at.members = members;
    at.z = z.head(effect_count);
    at.numbers = z.tail(number_count);
    const Model model = modelOf(at);
    return fidelity <= Fidelity::fine ? comparison.predicted(model, fidelity) : comparison.predicted(model);
  };
  return problem;
}

void Causes::refit(Explanation& explanation, const Comparison& comparison, int rounds, Fidelity fidelity, Accuracy accuracy,
                   std::vector<SharedVector> known, Known known_from, double largest_cost) const {
  const Eigen::Index effect_count = explanation.z.size();
  FitProblem problem = problemOf(explanation, comparison, Fidelity::coarse);
  if (!known.empty()) {
    problem.known_derivatives = std::move(known);
    problem.renewed_count = effect_count;
    problem.narrow_differences = false;
  }
  problem.largest_cost = largest_cost;
  problem.known_elsewhere = known_from == Known::elsewhere;
  if (accuracy == Accuracy::ranking) {
    problem.enough = roughly_enough;
    problem.still_valid = roughly_valid;
  }
  const FitResult result = fidelity == Fidelity::fine
                               ? fitCorrected(comparison, problem, problemOf(explanation, comparison, Fidelity::fine).predicted, rounds)
                               : fit(comparison, problem, rounds);
  take(explanation, result, rounds > 0 || explanation.half_width.size() == 0);
}

void Causes::refitHolding(Explanation& explanation, Eigen::Index coordinate, const Comparison& comparison, int rounds) const {
  FitProblem problem = problemOf(explanation, comparison, Fidelity::coarse);
  problem.clamped = [free = problem.clamped, coordinate, held = explanation.z[coordinate]](const Eigen::VectorXd& z) {
    Eigen::VectorXd result = free(z);
    result[coordinate] = held;
    return result;
  };
  problem.enough = roughly_enough;
  problem.still_valid = roughly_valid;
  take(explanation, fit(comparison, problem, rounds), true);
}

void Causes::finish(Explanation& explanation, const Comparison& comparison) const {
  take(explanation,
       musclesim::finish(comparison, problemOf(explanation, comparison, Fidelity::coarse),
                         problemOf(explanation, comparison, Fidelity::fine).predicted, explanation.residual,
                         plant_.hasStepError() ? problemOf(explanation, comparison, Fidelity::finer).predicted : Predicted{}),
       true);
}

}  // namespace musclesim
