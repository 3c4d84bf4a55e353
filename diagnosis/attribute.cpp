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

constexpr std::size_t single_count = 14;    ///< hypotheses that are fitted
constexpr std::size_t component_count = 8;  ///< hypotheses on the component of the best one that are fitted
constexpr std::size_t pair_count = 6;       ///< further effects that are fitted beside the best hypothesis
constexpr std::size_t base_count = 3;       ///< fitted hypotheses to which further effects are added
constexpr std::size_t fewer_pairs = 3;      ///< further effects that are fitted beside the second and third
constexpr double likely_share = 0.03;       ///< least probability of these, as a share of the best one's
constexpr double least_bound = -1.5;        ///< least optimistic bound, ln odds, for which a further effect is tried
constexpr int few_effects = 2;              ///< up to this many effects, one screening serves for all of them
constexpr int first_rounds = 2, square_rounds = 3, last_rounds = 2;
constexpr Eigen::Index many_coordinates =
    3;                           ///< from this number on, a fit also starts by plain least squares, because the misfit has many minima
constexpr int many_rounds = 12;  ///< in place of last_rounds if many effects act together
constexpr PruningMargins single_margins = {{0.8, 0.5}, {0.4, 0.15}}, pair_margins = {{0.25, 0}, {0.1, 0}};

}  // namespace

Attributor::Attributor(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation)
    : plant_(plant),
      options_(options),
      on_simulation_(std::move(on_simulation)),
      screening_(plant, plant.screeningSegments(), Comparison::Averages::with),
      fit_(plant, plant.split().fit, Comparison::Averages::with) {}

Model Attributor::modelOf(const FittedHypothesis& fitted) const {
  Model model;
  Eigen::Index first = 0;
  for (const std::size_t index : fitted.members) {
    const Hypothesis& hypothesis = result_.hypotheses[index];
    model.effects.push_back(hypothesis.at(fitted.z.segment(first, hypothesis.coordinateCount())));
    first += hypothesis.coordinateCount();
  }
  model.parameters = plant_.tunedAt(fitted.tuning);
  return model;
}

Eigen::VectorXd Attributor::startOf(std::size_t index, const Sensitivity& sensitivity) const {
  const Hypothesis& hypothesis = result_.hypotheses[index];
  Eigen::VectorXd z = Eigen::VectorXd::Zero(hypothesis.coordinateCount());
  for (std::size_t k = 0; k < hypothesis.strengths().size(); ++k) {
    const double amount = sensitivity.amount[static_cast<Eigen::Index>(k)];
    z[hypothesis.strengths()[k]] = sensitivity.from_threshold ? 1 : std::abs(amount) < 0.05 ? 0.05 : amount;
  }
  return z;
}

Eigen::VectorXd Attributor::clampedAll(const std::vector<std::size_t>& members, const Eigen::VectorXd& z) const {
  Eigen::VectorXd result = z;
  Eigen::Index first = 0;
  for (const std::size_t index : members) {
    const Eigen::Index count = result_.hypotheses[index].coordinateCount();
    result.segment(first, count) = result_.hypotheses[index].clamped(z.segment(first, count));
    first += count;
  }
  return result;
}

/// Fits the effects' coordinates and the tuned parameters together, because either could stand in for the other.
FitProblem Attributor::problemOf(const FittedHypothesis& fitted, const Comparison& comparison, Fidelity fidelity) const {
  const Eigen::Index effect_count = fitted.z.size(), tuned_count = fitted.tuning.size();
  FitProblem problem;
  problem.start.resize(effect_count + tuned_count);
  problem.start << fitted.z, fitted.tuning;
  problem.clamped = [this, members = fitted.members, effect_count, tuned_count](const Eigen::VectorXd& z) {
    Eigen::VectorXd result(z.size());
    result << clampedAll(members, z.head(effect_count)), Plant::clampedTuning(z.tail(tuned_count));
    return result;
  };
  problem.predicted = [this, members = fitted.members, effect_count, tuned_count, &comparison, fidelity](const Eigen::VectorXd& z) {
    on_simulation_();
    const Model model = modelOf({members, z.head(effect_count), {}, {}, 0, 0, z.tail(tuned_count)});
    return fidelity == Fidelity::fine ? comparison.predicted(model, Fidelity::fine) : comparison.predicted(model);
  };
  return problem;
}

void Attributor::refit(FittedHypothesis& fitted, const Comparison& comparison, int rounds, Fidelity fidelity) const {
  if (fitted.tuning.size() == 0) fitted.tuning = Eigen::VectorXd::Zero(plant_.tunedCount());
  const Eigen::Index effect_count = fitted.z.size(), tuned_count = fitted.tuning.size();
  const FitProblem problem = problemOf(fitted, comparison, Fidelity::coarse);
  const FitResult result = fidelity == Fidelity::fine
                               ? fitCorrected(comparison, problem, problemOf(fitted, comparison, Fidelity::fine).predicted, rounds)
                               : fit(comparison, problem, rounds);
  fitted.z = result.z.head(effect_count);
  fitted.tuning = result.z.tail(tuned_count);
  if (rounds > 0 || fitted.half_width.size() == 0) {
    fitted.half_width = result.half_width.head(effect_count);
    fitted.tuning_half_width = result.half_width.tail(tuned_count);
  }
  fitted.residual = result.residual;
  fitted.log_misfit = result.log_misfit / comparison.affectedBlocks(&comparison == &fit_ ? nominal_residual_ : screening_residual_);
}

/// Fits to all fitting segments, with fine time steps.
void Attributor::fitToAll(FittedHypothesis& fitted) const {
  if (fitted.fitted_to_all) return;
  refit(fitted, fit_, options_.max_effects > few_effects ? many_rounds : last_rounds, Fidelity::fine);
  takeFromCounterparts(fitted);
  fitted.is_inactive = hasInactiveEffect(fitted);
  fitted.fitted_to_all = true;
}

/// A parameter that the recordings do not determine takes the value of the other direction: a valve of which only the venting was recorded
/// is taken to fill at the same rate.
void Attributor::takeFromCounterparts(FittedHypothesis& fitted) const {
  constexpr double noticeable = 0.01;  // log misfit per affected block
  FittedHypothesis changed = fitted;
  Eigen::Index first = 0;
  for (const std::size_t index : fitted.members) {
    const Hypothesis& hypothesis = result_.hypotheses[index];
    for (int k = 0; k < hypothesis.coordinateCount(); ++k) {
      const int other = hypothesis.counterpartOf(k);
      if (other < 0 || std::isfinite(fitted.half_width[first + k]) || !std::isfinite(fitted.half_width[first + other])) continue;
      changed.z[first + k] = hypothesis.coordinateLike(k, other, fitted.z[first + other]);
    }
    first += hypothesis.coordinateCount();
  }
  changed.z = clampedAll(changed.members, changed.z);
  if (changed.z == fitted.z || plant_.interrupted()) return;
  refit(changed, fit_, 0, Fidelity::fine);
  if (changed.residual.size() == fit_.size() && changed.log_misfit < fitted.log_misfit + noticeable) fitted = changed;
}

/// Reduces the strengths of the last effect until the prediction on the screening segments is no worse than without it.
void Attributor::weakenStart(Candidate& candidate) const {
  constexpr double share = 0.3;
  constexpr int weakenings = 4;
  const Hypothesis& last = result_.hypotheses[candidate.fitted.members.back()];
  if (last.strengths().empty()) return;
  for (int i = 0; i < weakenings && !plant_.interrupted(); ++i) {
    const Eigen::VectorXd predicted = screening_.predicted(modelOf(candidate.fitted));
    on_simulation_();
    if (predicted.size() == screening_.size() && screening_.logMisfit(screening_.measured() - predicted) < candidate.without) return;
    for (const int strength : last.strengths()) candidate.fitted.z.tail(last.coordinateCount())[strength] *= share;
  }
}

/// Whether a further effect gains something on the screening segments after the first rounds; otherwise it will be improbable.
bool Attributor::gainsOnScreening(const Candidate& candidate) const {
  constexpr double least_gain = 0.1;
  const double without = candidate.without / screening_.affectedBlocks(screening_residual_);
  return candidate.fitted.members.size() == 1 || candidate.fitted.log_misfit < without - least_gain;
}

/// Whether a fitted hypothesis is close enough to the most probable one to be refined.
bool Attributor::isProbableEnough(const FittedHypothesis& fitted) const {
  constexpr double far_behind = 13.5;  // ln odds; a fit in fine steps may gain this much
  if (fitted.members.size() == 1) return true;
  double best = -std::numeric_limits<double>::infinity();
  for (const FittedHypothesis& other : result_.fits) best = std::max(best, odds().ofHypothesis(other));
  return fitted.residual.size() == fit_.size() && odds().ofHypothesis(fitted) > best - far_behind;
}

/// Keeps, of candidates with the same effects, the one with the least misfit, with a penalty per coordinate.
void Attributor::keepBetterOfSame(std::vector<Candidate>& candidates) const {
  constexpr double worth_a_coordinate = 0.05;  // log misfit per affected block
  auto costOf = [&](const FittedHypothesis& fitted) {
    return fitted.log_misfit + worth_a_coordinate * static_cast<double>(fitted.z.size());
  };
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    const auto same = std::ranges::find_if(kept, [&](const Candidate& other) { return sameEffects(other.fitted, candidate.fitted); });
    if (same == kept.end())
      kept.push_back(std::move(candidate));
    else if (costOf(candidate.fitted) < costOf(same->fitted))
      *same = std::move(candidate);
  }
  candidates = std::move(kept);
}

/// Fits candidates with one effect of many coordinates again, starting by plain least squares. Skipped if a candidate explains the
/// screening segments already.
std::vector<Attributor::Candidate> Attributor::begunBySquares(const std::vector<Candidate>& candidates) {
  constexpr double little = 0.2;  // of the log misfit
  double least = screening_.logMisfit(screening_residual_) / screening_.affectedBlocks(screening_residual_);
  const double much = little * least;
  for (const Candidate& candidate : candidates) least = std::min(least, candidate.fitted.log_misfit);
  for (const FittedHypothesis& fitted : result_.fits) least = std::min(least, fitted.log_misfit);
  std::vector<Candidate> result;
  for (const Candidate& candidate : candidates)
    if (const std::size_t index = candidate.fitted.members.front();
        least > much && candidate.fitted.members.size() == 1 && candidate.fitted.z.size() >= many_coordinates)
      result.push_back({{{index}, startOf(index, result_.sensitivities[index]), {}, {}, 0, 0}, candidate.without});
  parallelFor(static_cast<int>(result.size()), options_.job_count, [&](int i) {
    Candidate& candidate = result[static_cast<std::size_t>(i)];
    if (plant_.interrupted()) return;
    weakenStart(candidate);
    refit(candidate.fitted, screening_.bySquares(screening_residual_), square_rounds, Fidelity::coarse);
    refit(candidate.fitted, screening_, first_rounds, Fidelity::coarse);
  });
  return result;
}

/// Fits candidates in three rounds: a few steps on the screening segments, more steps there, then all fitting segments with fine time steps
/// (coarse ones blur what lasts some milliseconds). After each round only candidates within the pruning margin of the best continue; the
/// others keep their values, with their misfit on all fitting segments.
void Attributor::fitTogether(std::vector<Candidate> candidates, PruningMargins margins) {
  auto forEach = [&](const std::function<bool(const Candidate&)>& chosen, const std::function<void(Candidate&)>& work) {
    parallelFor(static_cast<int>(candidates.size()), options_.job_count, [&](int i) {
      Candidate& candidate = candidates[static_cast<std::size_t>(i)];
      if (!plant_.interrupted() && chosen(candidate)) work(candidate);
    });
  };
  auto limit = [&](const PruningMargin& margin) {
    double best = std::numeric_limits<double>::infinity();
    for (const Candidate& candidate : candidates) best = std::min(best, candidate.fitted.log_misfit);
    return best + margin.beyond_best + margin.share_of_best * std::max(0.0, best);
  };
  auto all = [](const Candidate&) { return true; };
  forEach(all, [&](Candidate& candidate) {
    weakenStart(candidate);
    refit(candidate.fitted, screening_, first_rounds, Fidelity::coarse);
  });
  std::ranges::move(begunBySquares(candidates), std::back_inserter(candidates));
  forEach([&, within = limit(margins.on_screening)](
              const Candidate& candidate) { return candidate.fitted.log_misfit <= within && gainsOnScreening(candidate); },
          [&](Candidate& candidate) { refit(candidate.fitted, screening_, more_rounds, Fidelity::coarse); });
  keepBetterOfSame(candidates);
  forEach(all, [&](Candidate& candidate) { refit(candidate.fitted, fit_, 0, Fidelity::coarse); });
  forEach([&, within = limit(margins.on_all)](
              const Candidate& candidate) { return candidate.fitted.log_misfit <= within && isProbableEnough(candidate.fitted); },
          [&](Candidate& candidate) { fitToAll(candidate.fitted); });
  for (Candidate& candidate : candidates)
    if (candidate.fitted.residual.size() == fit_.size()) result_.fits.push_back(std::move(candidate.fitted));
}

/// The best hypotheses by screening, and the best of every stage; each label once.
std::vector<std::size_t> Attributor::survivors(const std::vector<double>& log_misfit, std::size_t count, bool from_every_stage) const {
  std::vector<std::size_t> order(log_misfit.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return log_misfit[a] < log_misfit[b]; });
  std::vector<std::size_t> chosen;
  std::set<std::string> labels;
  std::map<Stage, int> per_stage;
  for (const std::size_t index : order) {
    const Hypothesis& hypothesis = result_.hypotheses[index];
    if (!result_.allowed[index] || !std::isfinite(log_misfit[index]) || labels.contains(hypothesis.label())) continue;
    const bool first_of_stage = from_every_stage && per_stage[hypothesis.info().stage] == 0;
    if (chosen.size() >= count && !first_of_stage) continue;
    chosen.push_back(index);
    labels.insert(hypothesis.label());
    ++per_stage[hypothesis.info().stage];
  }
  return chosen;
}

void Attributor::fitSingles() {
  std::vector<double> log_misfit;
  for (const Sensitivity& sensitivity : result_.sensitivities) log_misfit.push_back(sensitivity.log_misfit);
  fitAlone(survivors(log_misfit, single_count, true));
}

/// The chosen hypotheses, each with its next best variant by screening.
std::vector<std::size_t> Attributor::withSecondVariants(const std::vector<std::size_t>& chosen) const {
  std::vector<std::size_t> result;
  for (const std::size_t index : chosen) {
    result.push_back(index);
    std::optional<std::size_t> second;
    for (std::size_t i = 0; i < result_.hypotheses.size(); ++i)
      if (i != index && result_.hypotheses[i].label() == result_.hypotheses[index].label() &&
          std::isfinite(result_.sensitivities[i].log_misfit) &&
          (!second || result_.sensitivities[i].log_misfit < result_.sensitivities[*second].log_misfit))
        second = i;
    if (second) result.push_back(*second);
  }
  return result;
}

void Attributor::fitAlone(const std::vector<std::size_t>& chosen) {
  const double without = screening_.logMisfit(screening_residual_);
  std::vector<Candidate> candidates;
  for (const std::size_t index : withSecondVariants(chosen))
    candidates.push_back({{{index}, startOf(index, result_.sensitivities[index]), {}, {}, 0, 0}, without});
  fitTogether(std::move(candidates), single_margins);
}

/// Fits further hypotheses on the component of the best one, those of its stage first: look-alikes act there, and on a robot with many
/// components most of them may not be among the first survivors.
void Attributor::fitMoreOnTheBestComponent() {
  if (result_.fits.empty()) return;
  const Hypothesis& best = result_.hypotheses[result_.fits.front().members.front()];
  // With one muscle, "all" and "muscle_0" are the same place.
  const auto placeOf = [this](const Hypothesis& hypothesis) {
    return plant_.muscleCount() == 1 && hypothesis.component() == "all" ? std::string("muscle_0") : hypothesis.component();
  };
  const std::string component = placeOf(best);
  std::set<std::string> fitted_labels;
  for (const FittedHypothesis& fitted : result_.fits) {
    const Hypothesis& hypothesis = result_.hypotheses[fitted.members.front()];
    if (placeOf(hypothesis) == component) fitted_labels.insert(hypothesis.label());
  }
  const auto chosenAmong = [&](std::size_t count, const std::function<bool(const Hypothesis&)>& fits) {
    std::vector<double> log_misfit;
    for (std::size_t s = 0; s < result_.hypotheses.size(); ++s) {
      const bool wanted = fits(result_.hypotheses[s]) && !fitted_labels.contains(result_.hypotheses[s].label());
      log_misfit.push_back(wanted ? result_.sensitivities[s].log_misfit : std::numeric_limits<double>::infinity());
    }
    return survivors(log_misfit, count, false);
  };
  const auto is_there = [&](const Hypothesis& hypothesis) { return placeOf(hypothesis) == component; };
  const auto is_beside = [&](const Hypothesis& hypothesis) { return is_there(hypothesis) && hypothesis.info().stage == best.info().stage; };
  std::vector<std::size_t> chosen = chosenAmong(component_count, is_beside);
  for (const std::size_t index : chosen) fitted_labels.insert(result_.hypotheses[index].label());
  if (fitted_labels.size() < component_count)
    for (const std::size_t index : chosenAmong(component_count - fitted_labels.size(), is_there)) chosen.push_back(index);
  fitAlone(chosen);
}

/// Adds one further effect to the most probable hypotheses of `count` - 1 effects. Returns whether there was one to extend.
bool Attributor::fitFurther(std::size_t count) {
  std::vector<FittedHypothesis> bases;
  double likeliest = 0;
  for (const FittedHypothesis& fitted : result_.fits) {
    if (fitted.members.size() + 1 != count) continue;
    likeliest = std::max(likeliest, fitted.probability);
    if (bases.size() == base_count || fitted.probability < likely_share * likeliest) break;
    if (odds().optimisticBound(fitted) >= least_bound)
      bases.push_back(fitted);
    else if (bases.empty())
      return false;
  }
  std::vector<Candidate> candidates;
  for (const FittedHypothesis& base : bases) {
    const std::size_t most = &base == &bases.front() ? pair_count : fewer_pairs;
    for (Candidate& candidate : candidatesBeside(base, most)) {
      const auto same = [&](const Candidate& other) { return std::ranges::is_permutation(other.fitted.members, candidate.fitted.members); };
      if (std::ranges::none_of(candidates, same)) candidates.push_back(std::move(candidate));
    }
  }
  fitTogether(std::move(candidates), pair_margins);
  return !bases.empty();
}

/// Whether two fitted hypotheses have the same effects on the same components, in any order.
bool Attributor::sameEffects(const FittedHypothesis& one, const FittedHypothesis& other) const {
  auto labels = [&](const FittedHypothesis& fitted) {
    std::set<std::string> result;
    for (const std::size_t member : fitted.members) result.insert(result_.hypotheses[member].label());
    return result;
  };
  return labels(one) == labels(other);
}

/// Candidates that add one effect to `base`, chosen by their sensitivities on the residual of `base`.
std::vector<Attributor::Candidate> Attributor::candidatesBeside(const FittedHypothesis& base, std::size_t most) const {
  const Eigen::VectorXd predicted = screening_.predicted(modelOf(base));
  if (!predicted.size()) return {};
  const Eigen::VectorXd left = screening_.measured() - predicted;
  // With many effects, the change that one makes depends on the others, so they are screened again beside `base`.
  std::vector<Sensitivity> sensitivities = result_.sensitivities;
  if (options_.max_effects > few_effects) {
    std::vector<Hypothesis> hypotheses = result_.hypotheses;
    sensitivities = sensitivitiesOf(screening_, hypotheses, predicted, modelOf(base), Strengths::kept, options_.job_count, on_simulation_);
    for (std::size_t s = 0; s < sensitivities.size(); ++s) sensitivities[s].from_threshold = result_.sensitivities[s].from_threshold;
  }
  std::vector<double> log_misfit;
  for (std::size_t s = 0; s < sensitivities.size(); ++s) {
    fitLinearly(screening_, result_.hypotheses[s], left, sensitivities[s]);
    const bool same = std::ranges::any_of(
        base.members, [&](std::size_t member) { return result_.hypotheses[s].info().id == result_.hypotheses[member].info().id; });
    log_misfit.push_back(same ? std::numeric_limits<double>::infinity() : sensitivities[s].log_misfit);
  }
  std::vector<Candidate> candidates;
  for (const std::size_t index : withSecondVariants(survivors(log_misfit, most, false))) {
    const Eigen::VectorXd further = startOf(index, sensitivities[index]);
    FittedHypothesis fitted{base.members, Eigen::VectorXd(base.z.size() + further.size()), {}, {}, 0, 0, base.tuning};
    fitted.members.push_back(index);
    fitted.z << base.z, further;
    candidates.push_back({std::move(fitted), screening_.logMisfit(left)});
  }
  return candidates;
}

/// Computes the probabilities from the odds, of "none of these" and "no effect" too, and sorts by them.
void Attributor::weigh() {
  if (result_.fits.empty() && plant_.interrupted()) return;  // nothing is known yet
  std::vector<double> all = {odds().ofNoEffect(), odds().ofNoneOfThese(result_.fits)};
  for (const FittedHypothesis& fitted : result_.fits) all.push_back(odds().ofHypothesis(fitted));
  const double largest = *std::ranges::max_element(all);
  double sum = 0;
  for (double& value : all) sum += value = std::exp(value - largest);
  result_.no_effect = all[0] / sum;
  result_.none_of_these = all[1] / sum;
  for (std::size_t i = 0; i < result_.fits.size(); ++i) result_.fits[i].probability = all[i + 2] / sum;
  std::ranges::stable_sort(result_.fits,
                           [](const FittedHypothesis& a, const FittedHypothesis& b) { return a.probability > b.probability; });
}

/// The fitted hypothesis with the least misfit, with a penalty per effect.
const FittedHypothesis& Attributor::nearest() const {
  constexpr double worth_an_effect = 0.05;  // log misfit per affected block
  return *std::ranges::min_element(result_.fits, {}, [](const FittedHypothesis& fitted) {
    const double inactive = fitted.is_inactive ? std::numeric_limits<double>::infinity() : 0;
    return fitted.log_misfit + worth_an_effect * static_cast<double>(fitted.members.size()) + inactive;
  });
}

/// Uses the steps of derivatives().
Rival Attributor::rival(const FittedHypothesis& fitted, const std::string& label) const {
  Rival result{label, modelOf(fitted), fitted.probability, {}, {}};
  const FitProblem problem = problemOf(fitted, fit_, Fidelity::coarse);
  const Eigen::MatrixXd slopes = fit_.weights(fitted.residual).asDiagonal() * derivatives(fit_, problem, problem.start);
  std::vector<Eigen::Index> moving;
  for (Eigen::Index k = 0; k < problem.start.size(); ++k)
    if (stepOf(problem, problem.start, k) != 0) moving.push_back(k);
  result.slopes.resize(slopes.rows(), static_cast<Eigen::Index>(moving.size()));
  for (std::size_t i = 0; i < moving.size(); ++i) {
    Eigen::VectorXd z = problem.start;
    const double step = stepOf(problem, z, moving[i]);
    z[moving[i]] += step;
    FittedHypothesis moved = fitted;
    moved.z = z.head(fitted.z.size());
    moved.tuning = z.tail(fitted.tuning.size());
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
