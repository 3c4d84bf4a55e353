#include "attribute.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "../base/parallel.h"

namespace musclesim {

namespace {

constexpr std::size_t single_count = 14;    ///< suspects that are fitted
constexpr std::size_t component_count = 8;  ///< suspects on the component of the best that are fitted
constexpr std::size_t pair_count = 6;       ///< further effects that are fitted beside the best
constexpr std::size_t base_count = 3;       ///< explanations beside which further effects are looked for
constexpr std::size_t fewer_pairs = 3;      ///< further effects that are fitted beside the second and third of them
constexpr double likely_share = 0.03;       ///< of the best one's probability, that those have at least
constexpr double least_hope = -1.5;         ///< ln of the odds of one more effect that leaves nothing; below, none is looked for
constexpr int few_effects = 2;              ///< up to that many, the first look serves for all of them
constexpr int first_rounds = 2, square_rounds = 3, last_rounds = 2;
constexpr Eigen::Index many_coordinates = 3;  ///< from so many on, a fit also begins by plain least squares: the misfit has many minima
constexpr int many_rounds = 12;               ///< in place of the last rounds where many effects act together
constexpr Reach single_reach = {{0.8, 0.5}, {0.4, 0.15}}, pair_reach = {{0.25, 0}, {0.1, 0}};

/// A step of one coordinate as derivatives() takes it, to the side where there is room; 0 between two bounds.
double stepOf(const FitProblem& problem, const Eigen::VectorXd& z, Eigen::Index coordinate) {
  constexpr double difference = 0.2;
  for (const double side : {1.0, -1.0}) {
    Eigen::VectorXd moved = z;
    moved[coordinate] += side * difference * std::max(1.0, std::abs(z[coordinate]));
    if (const double step = problem.clamped(moved)[coordinate] - z[coordinate]; step != 0) return step;
  }
  return 0;
}

}  // namespace

Attributor::Attributor(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation)
    : plant_(plant),
      options_(options),
      on_simulation_(std::move(on_simulation)),
      look_(plant, plant.lookStretches(), Comparison::Averages::with),
      fit_(plant, plant.split().fit, Comparison::Averages::with) {}

Model Attributor::modelOf(const Explanation& explanation) const {
  Model model;
  Eigen::Index first = 0;
  for (const std::size_t index : explanation.suspects) {
    const Suspect& suspect = result_.suspects[index];
    model.effects.push_back(suspect.at(explanation.z.segment(first, suspect.coordinateCount())));
    first += suspect.coordinateCount();
  }
  model.parameters = plant_.tunedAt(explanation.tuning);
  return model;
}

Eigen::VectorXd Attributor::startOf(std::size_t index, const Signature& signature) const {
  const Suspect& suspect = result_.suspects[index];
  Eigen::VectorXd z = Eigen::VectorXd::Zero(suspect.coordinateCount());
  for (std::size_t k = 0; k < suspect.strengths().size(); ++k) {
    const double amount = signature.amount[static_cast<Eigen::Index>(k)];
    z[suspect.strengths()[k]] = signature.from_threshold ? 1 : std::abs(amount) < 0.05 ? 0.05 : amount;
  }
  return z;
}

Eigen::VectorXd Attributor::clampedAll(const std::vector<std::size_t>& members, const Eigen::VectorXd& z) const {
  Eigen::VectorXd result = z;
  Eigen::Index first = 0;
  for (const std::size_t index : members) {
    const Eigen::Index count = result_.suspects[index].coordinateCount();
    result.segment(first, count) = result_.suspects[index].clamped(z.segment(first, count));
    first += count;
  }
  return result;
}

/// The effects' coordinates and those of the numbers of the model that nobody measured, fitted together: either could stand in for the
/// other.
FitProblem Attributor::problemOf(const Explanation& explanation, const Comparison& comparison, Fidelity fidelity) const {
  const Eigen::Index effect_count = explanation.z.size(), tuned_count = explanation.tuning.size();
  FitProblem problem;
  problem.start.resize(effect_count + tuned_count);
  problem.start << explanation.z, explanation.tuning;
  problem.clamped = [this, members = explanation.suspects, effect_count, tuned_count](const Eigen::VectorXd& z) {
    Eigen::VectorXd result(z.size());
    result << clampedAll(members, z.head(effect_count)), Plant::clampedTuning(z.tail(tuned_count));
    return result;
  };
  problem.predicted = [this, members = explanation.suspects, effect_count, tuned_count, &comparison, fidelity](const Eigen::VectorXd& z) {
    on_simulation_();
    const Model model = modelOf({members, z.head(effect_count), {}, {}, 0, 0, z.tail(tuned_count)});
    return fidelity == Fidelity::fine ? comparison.predicted(model, Fidelity::fine) : comparison.predicted(model);
  };
  return problem;
}

void Attributor::refit(Explanation& explanation, const Comparison& comparison, int rounds, Fidelity fidelity) const {
  if (explanation.tuning.size() == 0) explanation.tuning = Eigen::VectorXd::Zero(plant_.tunedCount());
  const Eigen::Index effect_count = explanation.z.size(), tuned_count = explanation.tuning.size();
  const FitProblem problem = problemOf(explanation, comparison, Fidelity::coarse);
  const FitResult result = fidelity == Fidelity::fine
                               ? fitCorrected(comparison, problem, problemOf(explanation, comparison, Fidelity::fine).predicted, rounds)
                               : fit(comparison, problem, rounds);
  explanation.z = result.z.head(effect_count);
  explanation.tuning = result.z.tail(tuned_count);
  if (rounds > 0 || explanation.half_width.size() == 0) {
    explanation.half_width = result.half_width.head(effect_count);
    explanation.tuning_half_width = result.half_width.tail(tuned_count);
  }
  explanation.residual = result.residual;
  explanation.log_misfit = result.log_misfit / comparison.affectedCells(&comparison == &fit_ ? nominal_residual_ : look_residual_);
}

/// In fine steps.
void Attributor::fitToAll(Explanation& explanation) const {
  if (explanation.fitted_to_all) return;
  refit(explanation, fit_, options_.max_effects > few_effects ? many_rounds : last_rounds, Fidelity::fine);
  takeFromCounterparts(explanation);
  explanation.is_hollow = isHollow(explanation);
  explanation.fitted_to_all = true;
}

/// What the recordings do not determine takes the value of the other direction: a valve of which only the venting was recorded fills at the
/// same rate, for all that is known.
void Attributor::takeFromCounterparts(Explanation& explanation) const {
  constexpr double noticeable = 0.01;  // log misfit per affected cell
  Explanation changed = explanation;
  Eigen::Index first = 0;
  for (const std::size_t index : explanation.suspects) {
    const Suspect& suspect = result_.suspects[index];
    for (int k = 0; k < suspect.coordinateCount(); ++k) {
      const int other = suspect.counterpartOf(k);
      if (other < 0 || std::isfinite(explanation.half_width[first + k]) || !std::isfinite(explanation.half_width[first + other])) continue;
      changed.z[first + k] = suspect.coordinateLike(k, other, explanation.z[first + other]);
    }
    first += suspect.coordinateCount();
  }
  changed.z = clampedAll(changed.suspects, changed.z);
  if (changed.z == explanation.z || plant_.interrupted()) return;
  refit(changed, fit_, 0, Fidelity::fine);
  if (changed.residual.size() == fit_.size() && changed.log_misfit < explanation.log_misfit + noticeable) explanation = changed;
}

/// The last suspect's strengths are taken down until the prediction on the look is no worse than without it.
void Attributor::weakenStart(Candidate& candidate) const {
  constexpr double share = 0.3;
  constexpr int weakenings = 4;
  const Suspect& last = result_.suspects[candidate.explanation.suspects.back()];
  if (last.strengths().empty()) return;
  for (int i = 0; i < weakenings && !plant_.interrupted(); ++i) {
    const Eigen::VectorXd predicted = look_.predicted(modelOf(candidate.explanation));
    on_simulation_();
    if (predicted.size() == look_.size() && look_.logMisfit(look_.measured() - predicted) < candidate.without) return;
    for (const int strength : last.strengths()) candidate.explanation.z.tail(last.coordinateCount())[strength] *= share;
  }
}

/// A further effect that gains next to nothing on the look after the first steps will not be believed.
bool Attributor::gainsOnLook(const Candidate& candidate) const {
  constexpr double least_gain = 0.1;
  const double without = candidate.without / look_.affectedCells(look_residual_);
  return candidate.explanation.suspects.size() == 1 || candidate.explanation.log_misfit < without - least_gain;
}

/// Nor will one whose explanation is far behind the likeliest so far.
bool Attributor::mayBeBelieved(const Explanation& explanation) const {
  constexpr double far_behind = 13.5;  // ln of the odds; what a fit in fine steps may still gain
  if (explanation.suspects.size() == 1) return true;
  double best = -std::numeric_limits<double>::infinity();
  for (const Explanation& other : result_.explanations) best = std::max(best, odds().ofExplanation(other));
  return explanation.residual.size() == fit_.size() && odds().ofExplanation(explanation) > best - far_behind;
}

/// Of candidates with the same effects the one with the least misfit, where further coordinates must be worth their while.
void Attributor::keepBetterOfSame(std::vector<Candidate>& candidates) const {
  constexpr double worth_a_coordinate = 0.05;  // log misfit per affected cell
  auto costOf = [&](const Explanation& explanation) {
    return explanation.log_misfit + worth_a_coordinate * static_cast<double>(explanation.z.size());
  };
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    const auto same =
        std::ranges::find_if(kept, [&](const Candidate& other) { return sameEffects(other.explanation, candidate.explanation); });
    if (same == kept.end())
      kept.push_back(std::move(candidate));
    else if (costOf(candidate.explanation) < costOf(same->explanation))
      *same = std::move(candidate);
  }
  candidates = std::move(kept);
}

/// Candidates with one effect of many numbers once more, begun by plain least squares. Not where something explains the look already.
std::vector<Attributor::Candidate> Attributor::begunBySquares(const std::vector<Candidate>& candidates) {
  constexpr double little = 0.2;  // of the log misfit
  double least = look_.logMisfit(look_residual_) / look_.affectedCells(look_residual_);
  const double much = little * least;
  for (const Candidate& candidate : candidates) least = std::min(least, candidate.explanation.log_misfit);
  for (const Explanation& explanation : result_.explanations) least = std::min(least, explanation.log_misfit);
  std::vector<Candidate> result;
  for (const Candidate& candidate : candidates)
    if (const std::size_t index = candidate.explanation.suspects.front();
        least > much && candidate.explanation.suspects.size() == 1 && candidate.explanation.z.size() >= many_coordinates)
      result.push_back({{{index}, startOf(index, result_.signatures[index]), {}, {}, 0, 0}, candidate.without});
  parallelFor(static_cast<int>(result.size()), options_.job_count, [&](int i) {
    Candidate& candidate = result[static_cast<std::size_t>(i)];
    if (plant_.interrupted()) return;
    weakenStart(candidate);
    refit(candidate.explanation, look_.bySquares(look_residual_), square_rounds, Fidelity::coarse);
    refit(candidate.explanation, look_, first_rounds, Fidelity::coarse);
  });
  return result;
}

/// In three rounds, each for those that the round before left within reach of the best: a few steps on the look, more steps, all recordings
/// in fine steps (coarse ones blur what lasts some milliseconds). Those out of reach keep what they had, with their misfit on all
/// recordings.
void Attributor::fitTogether(std::vector<Candidate> candidates, Reach reach) {
  auto forEach = [&](const std::function<bool(const Candidate&)>& chosen, const std::function<void(Candidate&)>& work) {
    parallelFor(static_cast<int>(candidates.size()), options_.job_count, [&](int i) {
      Candidate& candidate = candidates[static_cast<std::size_t>(i)];
      if (!plant_.interrupted() && chosen(candidate)) work(candidate);
    });
  };
  auto limit = [&](const Distance& distance) {
    double best = std::numeric_limits<double>::infinity();
    for (const Candidate& candidate : candidates) best = std::min(best, candidate.explanation.log_misfit);
    return best + distance.beyond_best + distance.share_of_best * std::max(0.0, best);
  };
  auto all = [](const Candidate&) { return true; };
  forEach(all, [&](Candidate& candidate) {
    weakenStart(candidate);
    refit(candidate.explanation, look_, first_rounds, Fidelity::coarse);
  });
  std::ranges::move(begunBySquares(candidates), std::back_inserter(candidates));
  forEach([&, within = limit(reach.on_look)](
              const Candidate& candidate) { return candidate.explanation.log_misfit <= within && gainsOnLook(candidate); },
          [&](Candidate& candidate) { refit(candidate.explanation, look_, more_rounds, Fidelity::coarse); });
  keepBetterOfSame(candidates);
  forEach(all, [&](Candidate& candidate) { refit(candidate.explanation, fit_, 0, Fidelity::coarse); });
  forEach([&, within = limit(reach.on_all)](
              const Candidate& candidate) { return candidate.explanation.log_misfit <= within && mayBeBelieved(candidate.explanation); },
          [&](Candidate& candidate) { fitToAll(candidate.explanation); });
  for (Candidate& candidate : candidates)
    if (candidate.explanation.residual.size() == fit_.size()) result_.explanations.push_back(std::move(candidate.explanation));
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
    if (!result_.allowed[index] || !std::isfinite(log_misfit[index]) || labels.contains(suspect.label())) continue;
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
  fitAlone(survivors(log_misfit, single_count, true));
}

/// The chosen suspects, each with the variant of it that is next best on the first look.
std::vector<std::size_t> Attributor::withSecondVariants(const std::vector<std::size_t>& chosen) const {
  std::vector<std::size_t> result;
  for (const std::size_t index : chosen) {
    result.push_back(index);
    std::optional<std::size_t> second;
    for (std::size_t i = 0; i < result_.suspects.size(); ++i)
      if (i != index && result_.suspects[i].label() == result_.suspects[index].label() && std::isfinite(result_.signatures[i].log_misfit) &&
          (!second || result_.signatures[i].log_misfit < result_.signatures[*second].log_misfit))
        second = i;
    if (second) result.push_back(*second);
  }
  return result;
}

void Attributor::fitAlone(const std::vector<std::size_t>& chosen) {
  const double without = look_.logMisfit(look_residual_);
  std::vector<Candidate> candidates;
  for (const std::size_t index : withSecondVariants(chosen))
    candidates.push_back({{{index}, startOf(index, result_.signatures[index]), {}, {}, 0, 0}, without});
  fitTogether(std::move(candidates), single_reach);
}

/// What looks alike acts on the same component, most of all in the same stage; where there are many, most of it may not have been among the
/// first.
void Attributor::fitMoreOnTheBestComponent() {
  if (result_.explanations.empty()) return;
  const Suspect& best = result_.suspects[result_.explanations.front().suspects.front()];
  // A plant with one muscle has no other place for what acts on all.
  const auto placeOf = [this](const Suspect& suspect) {
    return plant_.muscleCount() == 1 && suspect.component() == "all" ? std::string("muscle_0") : suspect.component();
  };
  const std::string component = placeOf(best);
  std::set<std::string> fitted;
  for (const Explanation& explanation : result_.explanations) {
    const Suspect& suspect = result_.suspects[explanation.suspects.front()];
    if (placeOf(suspect) == component) fitted.insert(suspect.label());
  }
  const auto chosenAmong = [&](std::size_t count, const std::function<bool(const Suspect&)>& fits) {
    std::vector<double> log_misfit;
    for (std::size_t s = 0; s < result_.suspects.size(); ++s) {
      const bool wanted = fits(result_.suspects[s]) && !fitted.contains(result_.suspects[s].label());
      log_misfit.push_back(wanted ? result_.signatures[s].log_misfit : std::numeric_limits<double>::infinity());
    }
    return survivors(log_misfit, count, false);
  };
  const auto is_there = [&](const Suspect& suspect) { return placeOf(suspect) == component; };
  const auto is_beside = [&](const Suspect& suspect) { return is_there(suspect) && suspect.info().stage == best.info().stage; };
  std::vector<std::size_t> chosen = chosenAmong(component_count, is_beside);
  for (const std::size_t index : chosen) fitted.insert(result_.suspects[index].label());
  if (fitted.size() < component_count)
    for (const std::size_t index : chosenAmong(component_count - fitted.size(), is_there)) chosen.push_back(index);
  fitAlone(chosen);
}

/// A further effect is looked for beside the likeliest explanations of `count` - 1 effects. Returns whether there was anything to look for.
bool Attributor::fitFurther(std::size_t count) {
  std::vector<Explanation> bases;
  double likeliest = 0;
  for (const Explanation& explanation : result_.explanations) {
    if (explanation.suspects.size() + 1 != count) continue;
    likeliest = std::max(likeliest, explanation.probability);
    if (bases.size() == base_count || explanation.probability < likely_share * likeliest) break;
    if (odds().hopeBeyond(explanation) >= least_hope)
      bases.push_back(explanation);
    else if (bases.empty())
      return false;
  }
  std::vector<Candidate> candidates;
  for (const Explanation& base : bases) {
    const std::size_t most = &base == &bases.front() ? pair_count : fewer_pairs;
    for (Candidate& candidate : candidatesBeside(base, most)) {
      const auto same = [&](const Candidate& other) {
        return std::ranges::is_permutation(other.explanation.suspects, candidate.explanation.suspects);
      };
      if (std::ranges::none_of(candidates, same)) candidates.push_back(std::move(candidate));
    }
  }
  fitTogether(std::move(candidates), pair_reach);
  return !bases.empty();
}

/// Whether two explanations hold the same effects on the same components, in whatever order.
bool Attributor::sameEffects(const Explanation& one, const Explanation& other) const {
  auto labels = [&](const Explanation& explanation) {
    std::set<std::string> result;
    for (const std::size_t member : explanation.suspects) result.insert(result_.suspects[member].label());
    return result;
  };
  return labels(one) == labels(other);
}

/// One more effect each beside `base`, chosen by the first look's signatures on what that one leaves.
std::vector<Attributor::Candidate> Attributor::candidatesBeside(const Explanation& base, std::size_t most) const {
  const Eigen::VectorXd predicted = look_.predicted(modelOf(base));
  if (!predicted.size()) return {};
  const Eigen::VectorXd left = look_.measured() - predicted;
  // Where many effects act, what one changes depends on the others: they are looked at again beside what has been found.
  std::vector<Signature> signatures = result_.signatures;
  if (options_.max_effects > few_effects) {
    std::vector<Suspect> suspects = result_.suspects;
    signatures = screen(look_, suspects, predicted, modelOf(base), Strengths::kept, options_.job_count, on_simulation_);
    for (std::size_t s = 0; s < signatures.size(); ++s) signatures[s].from_threshold = result_.signatures[s].from_threshold;
  }
  std::vector<double> log_misfit;
  for (std::size_t s = 0; s < signatures.size(); ++s) {
    explain(look_, result_.suspects[s], left, signatures[s]);
    const bool same = std::ranges::any_of(
        base.suspects, [&](std::size_t member) { return result_.suspects[s].info().id == result_.suspects[member].info().id; });
    log_misfit.push_back(same ? std::numeric_limits<double>::infinity() : signatures[s].log_misfit);
  }
  std::vector<Candidate> candidates;
  for (const std::size_t index : withSecondVariants(survivors(log_misfit, most, false))) {
    const Eigen::VectorXd further = startOf(index, signatures[index]);
    Explanation explanation{base.suspects, Eigen::VectorXd(base.z.size() + further.size()), {}, {}, 0, 0, base.tuning};
    explanation.suspects.push_back(index);
    explanation.z << base.z, further;
    candidates.push_back({std::move(explanation), look_.logMisfit(left)});
  }
  return candidates;
}

/// Sorts by the odds; "none of these" and "no effect" are explanations like any other.
void Attributor::weigh() {
  if (result_.explanations.empty() && plant_.interrupted()) return;  // nothing is known yet
  std::vector<double> all = {odds().ofNoEffect(), odds().ofNoneOfThese(result_.explanations)};
  for (const Explanation& explanation : result_.explanations) all.push_back(odds().ofExplanation(explanation));
  const double largest = *std::ranges::max_element(all);
  double sum = 0;
  for (double& value : all) sum += value = std::exp(value - largest);
  result_.no_effect = all[0] / sum;
  result_.none_of_these = all[1] / sum;
  for (std::size_t i = 0; i < result_.explanations.size(); ++i) result_.explanations[i].probability = all[i + 2] / sum;
  std::ranges::stable_sort(result_.explanations, [](const Explanation& a, const Explanation& b) { return a.probability > b.probability; });
}

/// The explanation that leaves least, where every effect must be worth its while.
const Explanation& Attributor::nearest() const {
  constexpr double worth_an_effect = 0.05;  // log misfit per affected cell
  return *std::ranges::min_element(result_.explanations, {}, [](const Explanation& explanation) {
    const double hollow = explanation.is_hollow ? std::numeric_limits<double>::infinity() : 0;
    return explanation.log_misfit + worth_an_effect * static_cast<double>(explanation.suspects.size()) + hollow;
  });
}

/// With the steps of derivatives().
Contender Attributor::contender(const Explanation& explanation, const std::string& label) const {
  Contender result{label, modelOf(explanation), explanation.probability, {}, {}};
  const FitProblem problem = problemOf(explanation, fit_, Fidelity::coarse);
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
    moved.tuning = z.tail(explanation.tuning.size());
    result.beside.push_back(modelOf(moved));
    result.slopes.col(static_cast<Eigen::Index>(i)) = step * slopes.col(moving[i]);
  }
  return result;
}

void Attributor::decide() {
  fitSingles();
  weigh();
  fitMoreOnTheBestComponent();
  weigh();
  crossCheck();
  for (int count = 2; count <= options_.max_effects && fitFurther(static_cast<std::size_t>(count)); ++count) {
    weigh();
    crossCheck();
  }
}

}  // namespace musclesim
