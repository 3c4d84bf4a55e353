#include "attribute.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <set>

#include "parallel.h"

namespace musclesim {

namespace {

constexpr int look_rows = 1500;          ///< the look's stretches have that many rows together
constexpr std::size_t look_count = 3;    ///< recordings that are looked at
constexpr std::size_t single_count = 9;  ///< suspects that are fitted
constexpr std::size_t pair_count = 6;    ///< second effects that are fitted beside the best
constexpr double worth_a_pair = 0.15;    ///< log misfit per affected cell above which a second effect is looked for
constexpr int first_rounds = 2, more_rounds = 6, last_rounds = 2;
/// A fit goes on while its log misfit per affected cell is within that of the best: on the look, on all recordings.
struct Reach {
  double on_look, on_all;
};
constexpr Reach single_reach = {0.8, 0.4}, pair_reach = {0.25, 0.1};

bool sameCommands(const Recording& a, const Recording& b) {
  return std::ranges::all_of(a.signals, [&](const Signal& signal) {
    const Signal* other = b.find(signal.name);
    return !signal.name.starts_with("command_") || (other && other->values == signal.values);
  });
}

/// The beginnings of the first recordings with different commands.
std::vector<Stretch> lookStretches(const Plant& plant) {
  std::vector<Stretch> result;
  for (const Stretch& stretch : plant.split().fit) {
    auto recordingOf = [&](const Stretch& s) -> const Recording& { return plant.recordings()[static_cast<std::size_t>(s.recording)]; };
    const bool repeated =
        std::ranges::any_of(result, [&](const Stretch& other) { return sameCommands(recordingOf(stretch), recordingOf(other)); });
    if (!repeated && result.size() < look_count) result.push_back(stretch);
  }
  for (Stretch& stretch : result)
    stretch.end_row = std::min(stretch.end_row, stretch.first_row + look_rows / static_cast<int>(result.size()));
  return result;
}

}  // namespace

Attributor::Attributor(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation)
    : plant_(plant),
      options_(options),
      on_simulation_(std::move(on_simulation)),
      look_(plant, lookStretches(plant)),
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

void Attributor::refit(Explanation& explanation, const Comparison& comparison, int rounds) const {
  const std::vector<std::size_t>& members = explanation.suspects;
  FitProblem problem;
  problem.start = explanation.z;
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
  problem.predicted = [&](const Eigen::VectorXd& z) {
    on_simulation_();
    return comparison.predicted(modelOf({members, z, {}, {}, 0, 0, 0}));
  };
  const FitResult result = fit(comparison, problem, rounds);
  explanation.z = result.z;
  if (rounds > 0 || explanation.half_width.size() == 0) explanation.half_width = result.half_width;
  explanation.residual = result.residual;
  explanation.log_misfit = result.log_misfit / comparison.affectedCells(&comparison == &fit_ ? nominal_residual_ : look_residual_);
}

/// In three rounds, each for those that the round before left within reach of the best: a few steps on the look, more steps, all
/// recordings. Those out of reach keep what they had, with their misfit on all recordings.
void Attributor::fitTogether(std::vector<Explanation> candidates, double on_look, double on_all) {
  auto forEach = [&](const std::function<bool(const Explanation&)>& chosen, const std::function<void(Explanation&)>& work) {
    parallelFor(static_cast<int>(candidates.size()), options_.job_count, [&](int i) {
      Explanation& candidate = candidates[static_cast<std::size_t>(i)];
      if (!plant_.interrupted() && chosen(candidate)) work(candidate);
    });
  };
  auto within = [&](double reach) {
    double best = std::numeric_limits<double>::infinity();
    for (const Explanation& candidate : candidates) best = std::min(best, candidate.log_misfit);
    return [limit = best + reach](const Explanation& candidate) { return candidate.log_misfit <= limit; };
  };
  forEach([](const Explanation&) { return true; }, [&](Explanation& candidate) { refit(candidate, look_, first_rounds); });
  forEach(within(on_look), [&](Explanation& candidate) { refit(candidate, look_, more_rounds); });
  const auto is_close = within(on_all);
  forEach([](const Explanation&) { return true; },
          [&](Explanation& candidate) { refit(candidate, fit_, is_close(candidate) ? last_rounds : 0); });
  for (Explanation& candidate : candidates)
    if (candidate.residual.size() == fit_.size()) result_.explanations.push_back(std::move(candidate));
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
  std::vector<Explanation> candidates;
  for (const std::size_t index : chosen) candidates.push_back({{index}, startOf(index, result_.signatures[index]), {}, {}, 0, 0, 0});
  fitTogether(std::move(candidates), single_reach.on_look, single_reach.on_all);
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
  std::vector<Explanation> candidates;
  for (const std::size_t index : chosen) {
    const Eigen::VectorXd second = startOf(index, signatures[index]);
    Eigen::VectorXd start(best.z.size() + second.size());
    start << best.z, second;
    candidates.push_back({{best.suspects.front(), index}, start, {}, {}, 0, 0, 0});
  }
  fitTogether(std::move(candidates), pair_reach.on_look, pair_reach.on_all);
}

void Attributor::sort() {
  std::ranges::stable_sort(result_.explanations, [](const Explanation& a, const Explanation& b) { return a.probability > b.probability; });
}

/// Mean over affected cells of ln(RMS / floor), where floor^2 = noise floor^2 + (mismatch * RMS without any effect)^2.
double Attributor::weighedMisfit(const std::function<double(const Comparison::Cell&)>& mean_square, double mismatch) const {
  double sum = 0;
  for (const Comparison::Cell& cell : fit_.cells()) {
    const double square = mismatch * mismatch * fit_.meanSquare(cell, nominal_residual_);
    sum += 0.5 * std::log(std::max(1.0, mean_square(cell) / (cell.floor * cell.floor + square)));
  }
  return sum / fit_.affectedCells(nominal_residual_);
}

double Attributor::weighedMisfit(const Eigen::VectorXd& residual, double mismatch) const {
  return weighedMisfit([&](const Comparison::Cell& cell) { return fit_.meanSquare(cell, residual); }, mismatch);
}

/// Of a pair: what its first effect leaves alone, less what the second one gains where a wrong law is forgiven more.
double Attributor::weighedMisfit(const Explanation& explanation) const {
  if (explanation.suspects.size() < 2) return weighedMisfit(explanation.residual, weighing_.law_mismatch);
  const auto first = std::ranges::find_if(result_.explanations, [&](const Explanation& other) {
    return other.suspects.size() == 1 && other.suspects.front() == explanation.suspects.front();
  });
  return weighedMisfit(first->residual, weighing_.law_mismatch) - weighedMisfit(first->residual, weighing_.second_mismatch) +
         weighedMisfit(explanation.residual, weighing_.second_mismatch);
}

/// odds = exp(-per_misfit * weighed misfit - costs); "none of these" and "no effect" are explanations like any other.
void Attributor::weigh() {
  auto logOdds = [&](double misfit, Eigen::Index parameters, std::size_t effects) {
    return -weighing_.per_misfit * misfit - weighing_.per_parameter * static_cast<double>(parameters) -
           weighing_.per_effect * (static_cast<double>(effects) - 1);
  };
  const double no_effect = weighedMisfit(nominal_residual_, weighing_.law_mismatch);
  const double none = weighedMisfit(
      [&](const Comparison::Cell& cell) {
        const double before = std::sqrt(fit_.meanSquare(cell, nominal_residual_)), least = weighing_.none_floor_ratio * cell.floor;
        const double after = before > least ? std::max(least, weighing_.none_ratio * before) : before;
        return after * after;
      },
      weighing_.law_mismatch);
  std::vector<double> odds = {logOdds(no_effect, 0, 1), logOdds(none, 1, 1)};
  for (Explanation& explanation : result_.explanations) {
    explanation.weighed_misfit = weighedMisfit(explanation);
    odds.push_back(logOdds(explanation.weighed_misfit, explanation.z.size(), explanation.suspects.size()));
  }
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
