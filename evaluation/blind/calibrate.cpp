#include "calibrate.h"

#include <algorithm>
#include <cmath>

#include "../../diagnosis/search/evidence.h"
#include "judge_set.h"
#include "musclesim/base/error.h"
#include "seal.h"

namespace musclesim::blind {

using nlohmann::json;

namespace {

constexpr double ridge = 0.5;  ///< nats for an e-fold of one weight: a few dozen cases do not determine all
constexpr int fold_count = 5;

Eigen::VectorXd weightsInForce() {
  const auto nats = prices.asArray();
  Eigen::VectorXd result(tolerances.size() + nats.size());
  for (std::size_t i = 0; i < tolerances.size(); ++i) result[static_cast<Eigen::Index>(i)] = tolerances[i].nats;
  for (std::size_t i = 0; i < nats.size(); ++i) result[static_cast<Eigen::Index>(tolerances.size() + i)] = nats[i];
  return result;
}

Eigen::VectorXd probabilities(const TriedCase& one, const Eigen::VectorXd& weights) {
  const Eigen::VectorXd score = -(one.features * weights) - one.numbers_cost;
  const Eigen::ArrayXd odds = (score.array() - score.maxCoeff()).exp();
  return odds / odds.sum();
}

double probabilityOfRight(const TriedCase& one, const Eigen::VectorXd& p) {
  double sum = 0;
  for (std::size_t i = 0; i < one.is_right.size(); ++i) sum += one.is_right[i] ? p[static_cast<Eigen::Index>(i)] : 0;
  return std::max(sum, 1e-12);
}

/// The objective to minimise and its gradient by theta = ln(weights / weights in force).
double objective(const std::vector<const TriedCase*>& cases, const Eigen::VectorXd& theta, Eigen::VectorXd& gradient) {
  const Eigen::VectorXd weights = weightsInForce().array() * theta.array().exp();
  double sum = 0.5 * ridge * theta.squaredNorm();
  gradient = ridge * theta;
  for (const TriedCase* one : cases) {
    const Eigen::VectorXd p = probabilities(*one, weights);
    const double right = probabilityOfRight(*one, p);
    sum -= std::log(right);
    Eigen::VectorXd among_right = p / right;
    for (std::size_t i = 0; i < one->is_right.size(); ++i)
      if (!one->is_right[i]) among_right[static_cast<Eigen::Index>(i)] = 0;
    gradient.array() += (one->features.transpose() * (among_right - p)).array() * weights.array();
  }
  return sum;
}

/// Gradient descent with a step that halves until it gains (Armijo) and doubles when it does.
Eigen::VectorXd fittedWeights(const std::vector<const TriedCase*>& cases) {
  constexpr int most_steps = 2000;
  constexpr double enough = 1e-7, share = 1e-4;
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(weightsInForce().size()), gradient, next_gradient;
  double value = objective(cases, theta, gradient), step = 0.1;
  for (int i = 0; i < most_steps; ++i) {
    const Eigen::VectorXd next = theta - step * gradient;
    const double next_value = objective(cases, next, next_gradient);
    if (next_value > value - share * step * gradient.squaredNorm()) {
      step *= 0.5;
      if (step < enough) break;
      continue;
    }
    const double gain = value - next_value;
    theta = next;
    value = next_value;
    gradient = next_gradient;
    step *= 2;
    if (gain < enough) break;
  }
  return weightsInForce().array() * theta.array().exp();
}

bool isFirstRight(const TriedCase& one, const Eigen::VectorXd& p) {
  Eigen::Index first = 0;
  p.maxCoeff(&first);
  return one.is_right[static_cast<std::size_t>(first)];
}

}  // namespace

bool TriedCase::isUsable() const {
  return std::ranges::find(is_right, true) != is_right.end() && std::ranges::find(is_right, false) != is_right.end();
}

std::vector<std::string> weightNames() {
  std::vector<std::string> names;
  for (const Tolerance& tolerance : tolerances) names.push_back("misfit beyond " + std::to_string(tolerance.share_of_gap).substr(0, 4));
  names.insert(names.end(), {"parameters", "effects", "same_place", "excess", "shared_sensor", "places"});
  return names;
}

std::vector<TriedCase> triedCases(const std::filesystem::path& keys, const std::filesystem::path& answers) {
  const json all = readObject(keys);
  std::vector<TriedCase> result;
  try {
    for (const auto& [name, key] : all.contains("cases") ? all.at("cases").items() : all.items()) {
      const std::filesystem::path file = answers / (name + ".json");
      if (!key.is_object() || !std::filesystem::exists(file)) continue;
      const json answer = readObject(file);
      const json trials = answer.contains("fitted") ? answer.at("fitted").at("trials") : json::array();
      TriedCase one{name, Eigen::MatrixXd(trials.size(), weightsInForce().size()), Eigen::VectorXd(trials.size()), {}};
      for (std::size_t i = 0; i < trials.size(); ++i) {
        std::vector<double> features = trials[i].at("misfits");
        const std::vector<double> complexity = trials[i].at("complexity");
        features.insert(features.end(), complexity.begin(), complexity.end());
        const auto row = static_cast<Eigen::Index>(i);
        one.features.row(row) = Eigen::Map<const Eigen::VectorXd>(features.data(), static_cast<Eigen::Index>(features.size()));
        one.numbers_cost[row] = trials[i].at("numbers_cost");
        one.is_right.push_back(isWholeTruth(key, trials[i].at("effects")));
      }
      result.push_back(std::move(one));
    }
  } catch (const json::exception& e) {
    throw BadFile(answers.string(), std::string("holds answers without what they were weighed by: ") + e.what());
  }
  return result;
}

Calibration calibrate(const std::vector<TriedCase>& cases) {
  Calibration result;
  result.before = weightsInForce();
  std::vector<const TriedCase*> usable;
  for (const TriedCase& one : cases) {
    (one.isUsable() ? result.used : result.unused).push_back(one.name);
    if (one.isUsable()) usable.push_back(&one);
  }
  result.after = fittedWeights(usable);
  for (int fold = 0; fold < fold_count; ++fold) {
    std::vector<const TriedCase*> others;
    for (std::size_t i = 0; i < usable.size(); ++i)
      if (static_cast<int>(i % fold_count) != fold) others.push_back(usable[i]);
    const Eigen::VectorXd weights = fittedWeights(others);
    for (std::size_t i = static_cast<std::size_t>(fold); i < usable.size(); i += fold_count) {
      const Eigen::VectorXd before = probabilities(*usable[i], result.before), after = probabilities(*usable[i], weights);
      const auto count = static_cast<double>(usable.size());
      result.mean_ln_before += std::log(probabilityOfRight(*usable[i], before)) / count;
      result.mean_ln_after += std::log(probabilityOfRight(*usable[i], after)) / count;
      result.first_before += isFirstRight(*usable[i], before) ? 1 : 0;
      result.first_after += isFirstRight(*usable[i], after) ? 1 : 0;
    }
  }
  return result;
}

}  // namespace musclesim::blind
