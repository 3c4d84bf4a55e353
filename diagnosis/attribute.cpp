#include "attribute.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include "parallel.h"

namespace musclesim {

namespace {

constexpr int look_rows = 900;           ///< the first look ends after that many rows of a stretch
constexpr std::size_t single_count = 7;  ///< suspects that are fitted
constexpr std::size_t pair_count = 5;    ///< second effects that are fitted beside the best
constexpr double worth_a_pair = 0.15;    ///< log misfit per affected cell above which a second effect is looked for
constexpr int round_count = 8;

/// At most two stretches, the first and the last, and not more than look_rows of each.
std::vector<Stretch> lookStretches(const Split& split) {
  std::vector<Stretch> result = {split.fit.front()};
  if (split.fit.size() > 1) result.push_back(split.fit.back());
  for (Stretch& stretch : result) stretch.end_row = std::min(stretch.end_row, stretch.first_row + look_rows);
  return result;
}

}  // namespace

Attributor::Attributor(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation)
    : plant_(plant),
      options_(options),
      on_simulation_(std::move(on_simulation)),
      look_(plant, lookStretches(plant.split())),
      fit_(plant, plant.split().fit) {}

void Attributor::look() {
  const Eigen::VectorXd nominal = look_.predicted(Model{});
  if (!nominal.size()) throw Diverged(0, plant_.robot(), "the model without further effects cannot follow the recordings");
  look_residual_ = look_.measured() - nominal;
  nominal_residual_ = fit_.measured() - fit_.predicted(Model{});
  result_.suspects = suspects(plant_, options_);
  result_.signatures = screen(look_, result_.suspects, nominal, options_.job_count, on_simulation_);
}

Model Attributor::modelOf(const Explanation& explanation) const {
  Model model;
  Eigen::Index first = 0;
  for (const std::size_t index : explanation.suspects) {
    const Suspect& suspect = result_.suspects[index];
    model.effects.push_back(suspect.at(explanation.z.segment(first, suspect.coordinateCount())));
    first += suspect.coordinateCount();
  }
  return model;
}

Eigen::VectorXd Attributor::startOf(std::size_t index, const Signature& signature) const {
  const Suspect& suspect = result_.suspects[index];
  Eigen::VectorXd z = Eigen::VectorXd::Zero(suspect.coordinateCount());
  for (std::size_t k = 0; k < suspect.strengths().size(); ++k) {
    const double amount = signature.amount[static_cast<Eigen::Index>(k)];
    z[suspect.strengths()[k]] = std::abs(amount) < 0.05 ? 0.05 : amount;
  }
  return z;
}

Explanation Attributor::refit(const std::vector<std::size_t>& members, const Eigen::VectorXd& start, int rounds) const {
  Explanation explanation{members, start, {}, {}, 0, 0};
  FitProblem problem;
  problem.start = start;
  problem.clamped = [&](const Eigen::VectorXd& z) {
    Eigen::VectorXd result = z;
    Eigen::Index first = 0;
    for (const std::size_t index : members) {
      const Eigen::Index count = result_.suspects[index].coordinateCount();
      result.segment(first, count) = result_.suspects[index].clamped(z.segment(first, count));
      first += count;
    }
    return result;
  };
  auto fitOn = [&](const Comparison& comparison, int some) {
    problem.predicted = [&](const Eigen::VectorXd& z) {
      on_simulation_();
      return comparison.predicted(modelOf({members, z, {}, {}, 0, 0}));
    };
    return fit(comparison, problem, some);
  };
  problem.start = fitOn(look_, rounds).z;
  const FitResult all = fitOn(fit_, 2);
  explanation.z = all.z;
  explanation.half_width = all.half_width;
  explanation.residual = all.residual;
  explanation.log_misfit = all.log_misfit / fit_.affectedCells(nominal_residual_);
  return explanation;
}

/// The best by the first look, and the best of every stage; each id and component once.
std::vector<std::size_t> Attributor::survivors(const std::vector<double>& log_misfit, std::size_t count, bool from_every_stage) const {
  std::vector<std::size_t> order(log_misfit.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return log_misfit[a] < log_misfit[b]; });
  std::vector<std::size_t> chosen;
  std::set<std::string> labels;
  std::map<Stage, int> per_stage;
  for (const std::size_t index : order) {
    const Suspect& suspect = result_.suspects[index];
    if (!std::isfinite(log_misfit[index]) || labels.contains(suspect.label())) continue;
    const bool first_of_stage = from_every_stage && per_stage[suspect.info().stage] == 0;
    if (chosen.size() >= count && !first_of_stage) continue;
    chosen.push_back(index);
    labels.insert(suspect.label());
    ++per_stage[suspect.info().stage];
  }
  return chosen;
}

void Attributor::fitSingles() {
  std::vector<double> log_misfit;
  for (const Signature& signature : result_.signatures) log_misfit.push_back(signature.log_misfit);
  const std::vector<std::size_t> chosen = survivors(log_misfit, single_count, true);
  std::vector<Explanation> fitted(chosen.size());
  parallelFor(static_cast<int>(chosen.size()), options_.job_count, [&](int i) {
    const std::size_t index = chosen[static_cast<std::size_t>(i)];
    if (plant_.interrupted()) return;
    fitted[static_cast<std::size_t>(i)] = refit({index}, startOf(index, result_.signatures[index]), round_count);
  });
  for (Explanation& explanation : fitted)
    if (explanation.residual.size()) result_.explanations.push_back(std::move(explanation));
}

/// Second effects are looked for with the first look's signatures on what the best single effect leaves.
void Attributor::fitPairs() {
  if (result_.explanations.empty() || result_.explanations.front().log_misfit < worth_a_pair) return;
  const Explanation best = result_.explanations.front();
  const Eigen::VectorXd predicted = look_.predicted(modelOf(best));
  if (!predicted.size()) return;
  const Eigen::VectorXd left = look_.measured() - predicted;
  std::vector<Signature> signatures = result_.signatures;
  std::vector<double> log_misfit;
  for (std::size_t s = 0; s < signatures.size(); ++s) {
    explain(look_, result_.suspects[s], left, signatures[s]);
    const bool same = result_.suspects[s].info().id == result_.suspects[best.suspects.front()].info().id;
    log_misfit.push_back(same ? std::numeric_limits<double>::infinity() : signatures[s].log_misfit);
  }
  const std::vector<std::size_t> chosen = survivors(log_misfit, pair_count, false);
  std::vector<Explanation> fitted(chosen.size());
  parallelFor(static_cast<int>(chosen.size()), options_.job_count, [&](int i) {
    const std::size_t index = chosen[static_cast<std::size_t>(i)];
    if (plant_.interrupted()) return;
    const Eigen::VectorXd second = startOf(index, signatures[index]);
    Eigen::VectorXd start(best.z.size() + second.size());
    start << best.z, second;
    fitted[static_cast<std::size_t>(i)] = refit({best.suspects.front(), index}, start, round_count);
  });
  for (Explanation& explanation : fitted)
    if (explanation.residual.size()) result_.explanations.push_back(std::move(explanation));
}

void Attributor::sort() {
  std::ranges::stable_sort(result_.explanations, [](const Explanation& a, const Explanation& b) { return a.probability > b.probability; });
}

/// odds = exp(-per_misfit * log misfit - costs); "none of these" and "no effect" are explanations like any other.
void Attributor::weigh() {
  const double affected = fit_.affectedCells(nominal_residual_);
  auto logOdds = [&](double log_misfit, Eigen::Index parameters, std::size_t effects) {
    return -weighing_.per_misfit * log_misfit - weighing_.per_parameter * static_cast<double>(parameters) -
           weighing_.per_effect * (static_cast<double>(effects) - 1);
  };
  double none_misfit = 0;
  for (const Comparison::Cell& cell : fit_.cells()) {
    const double ratio = std::sqrt(fit_.meanSquare(cell, nominal_residual_)) / cell.floor;
    if (ratio > weighing_.none_floor_ratio)
      none_misfit += std::log(std::max(weighing_.none_floor_ratio, weighing_.none_ratio * ratio)) / affected;
    else
      none_misfit += std::log(std::max(1.0, ratio)) / affected;
  }
  std::vector<double> odds = {logOdds(fit_.logMisfit(nominal_residual_) / affected, 0, 1), logOdds(none_misfit, 1, 1)};
  for (const Explanation& explanation : result_.explanations)
    odds.push_back(logOdds(explanation.log_misfit, explanation.z.size(), explanation.suspects.size()));
  const double largest = *std::ranges::max_element(odds);
  double sum = 0;
  for (double& value : odds) sum += value = std::exp(value - largest);
  result_.no_effect = odds[0] / sum;
  result_.none_of_these = odds[1] / sum;
  for (std::size_t i = 0; i < result_.explanations.size(); ++i) result_.explanations[i].probability = odds[i + 2] / sum;
}

void Attributor::decide() {
  fitSingles();
  weigh();
  sort();
  if (options_.max_effects >= 2) {
    fitPairs();
    weigh();
    sort();
  }
}

}  // namespace musclesim
