#include "attribute.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <set>

#include "data_checks.h"
#include "parallel.h"

namespace musclesim {

namespace {

constexpr int look_rows = 1500;             ///< the look's stretches have that many rows together
constexpr std::size_t look_count = 3;       ///< recordings that are looked at
constexpr std::size_t single_count = 14;    ///< suspects that are fitted
constexpr std::size_t component_count = 8;  ///< suspects on the component of the best that are fitted
constexpr std::size_t pair_count = 6;       ///< further effects that are fitted beside the best
constexpr double least_hope = -1;           ///< ln of the odds of one more effect that leaves nothing; below, none is looked for
constexpr int few_effects = 2;              ///< up to that many, the first look serves for all of them
constexpr int first_rounds = 2, more_rounds = 6, last_rounds = 2;
constexpr int many_rounds = 12;  ///< in place of the last rounds where many effects act together
constexpr Reach single_reach = {0.8, 0.4}, pair_reach = {0.25, 0.1};

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
      look_(plant, lookStretches(plant), Comparison::Averages::with),
      fit_(plant, plant.split().fit, Comparison::Averages::with) {}

/// Of variants without any strength (numbers of bits), those of one component that leave least on the first stretch of the look: simulating
/// all of them on all of it would take as long as everything else.
void Attributor::keepNearestVariants() {
  constexpr std::size_t kept = 2;
  const Comparison brief = [&] {
    Comparison result(plant_, {look_.stretches().front()}, Comparison::Averages::with);
    result.goCoarse(result.predicted(Model{}));
    return result;
  }();
  std::vector<Suspect>& all = result_.suspects;
  std::map<std::string, std::vector<std::size_t>> variants;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].coordinateCount() == 0) variants[all[i].label()].push_back(i);
  std::vector<double> log_misfit(all.size(), 0);
  std::vector<std::size_t> tried;
  for (const auto& [label, members] : variants)
    if (members.size() > kept) tried.insert(tried.end(), members.begin(), members.end());
  parallelFor(static_cast<int>(tried.size()), options_.job_count, [&](int i) {
    const std::size_t index = tried[static_cast<std::size_t>(i)];
    if (plant_.interrupted()) return;
    const Eigen::VectorXd predicted = brief.predicted(Model{{all[index].at({})}, {}});
    log_misfit[index] = predicted.size() ? brief.logMisfit(brief.measured() - predicted) : std::numeric_limits<double>::infinity();
    on_simulation_();
  });
  std::set<std::size_t> dropped;
  for (auto& [label, members] : variants) {
    std::ranges::stable_sort(members, {}, [&](std::size_t i) { return log_misfit[i]; });
    if (members.size() <= kept) continue;
    dropped.insert(members.begin() + static_cast<std::ptrdiff_t>(kept), members.end());
    result_.thinned.insert(label);
  }
  std::vector<Suspect> rest;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!dropped.contains(i)) rest.push_back(std::move(all[i]));
  all = std::move(rest);
}

void Attributor::look() {
  const Eigen::VectorXd nominal = look_.predicted(Model{});
  if (!nominal.size()) throw Diverged(0, plant_.robot(), "the model without further effects cannot follow the recordings");
  look_residual_ = look_.measured() - nominal;
  const Eigen::VectorXd everywhere = fit_.predicted(Model{});
  nominal_residual_ = fit_.measured() - everywhere;
  look_.goCoarse(nominal);
  fit_.goCoarse(everywhere);
  result_.suspects = suspects(plant_, DiagnosisOptions{});
  keepNearestVariants();
  for (const Suspect& suspect : result_.suspects) result_.allowed.push_back(allows(options_, suspect.info().id));
  result_.signatures = screen(look_, result_.suspects, nominal, Model{}, Strengths::adapted, options_.job_count, on_simulation_);
}

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
    z[suspect.strengths()[k]] = std::abs(amount) < 0.05 ? 0.05 : amount;
  }
  return z;
}

/// The effects' coordinates and those of the numbers of the model that nobody measured, fitted together: either could stand in for the
/// other.
void Attributor::refit(Explanation& explanation, const Comparison& comparison, int rounds, Fidelity fidelity) const {
  const std::vector<std::size_t>& members = explanation.suspects;
  const Eigen::Index effect_count = explanation.z.size(), tuned_count = plant_.tunedCount();
  if (explanation.tuning.size() == 0) explanation.tuning = Eigen::VectorXd::Zero(tuned_count);
  FitProblem problem;
  problem.start.resize(effect_count + tuned_count);
  problem.start << explanation.z, explanation.tuning;
  problem.clamped = [&](const Eigen::VectorXd& z) {
    Eigen::VectorXd result = z;
    Eigen::Index first = 0;
    for (const std::size_t index : members) {
      const Eigen::Index count = result_.suspects[index].coordinateCount();
      result.segment(first, count) = result_.suspects[index].clamped(z.segment(first, count));
      first += count;
    }
    result.tail(tuned_count) = Plant::clampedTuning(z.tail(tuned_count));
    return result;
  };
  auto modelAt = [&](const Eigen::VectorXd& z) {
    on_simulation_();
    return modelOf({members, z.head(effect_count), {}, {}, 0, 0, z.tail(tuned_count)});
  };
  problem.predicted = [&](const Eigen::VectorXd& z) { return comparison.predicted(modelAt(z)); };
  auto exact = [&](const Eigen::VectorXd& z) { return comparison.predicted(modelAt(z), Fidelity::fine); };
  const FitResult result = fidelity == Fidelity::fine ? fitCorrected(comparison, problem, exact, rounds) : fit(comparison, problem, rounds);
  explanation.z = result.z.head(effect_count);
  explanation.tuning = result.z.tail(tuned_count);
  if (rounds > 0 || explanation.half_width.size() == 0) {
    explanation.half_width = result.half_width.head(effect_count);
    explanation.tuning_half_width = result.half_width.tail(tuned_count);
  }
  explanation.residual = result.residual;
  explanation.log_misfit = result.log_misfit / comparison.affectedCells(&comparison == &fit_ ? nominal_residual_ : look_residual_);
}

/// The last suspect's strengths are taken down until the prediction on the look is no worse than without it.
void Attributor::weakenStart(Explanation& candidate, double without) const {
  constexpr double share = 0.3;
  constexpr int weakenings = 4;
  const Suspect& last = result_.suspects[candidate.suspects.back()];
  if (last.strengths().empty()) return;
  for (int i = 0; i < weakenings && !plant_.interrupted(); ++i) {
    const Eigen::VectorXd predicted = look_.predicted(modelOf(candidate));
    on_simulation_();
    if (predicted.size() == look_.size() && look_.logMisfit(look_.measured() - predicted) < without) return;
    for (const int strength : last.strengths()) candidate.z.tail(last.coordinateCount())[strength] *= share;
  }
}

/// `without` is the misfit on the look without the last suspect. In three rounds, each for those that the round before left within reach of
/// the best: a few steps on the look, more steps, all recordings in fine steps (coarse ones blur what lasts some milliseconds). Those out
/// of reach keep what they had, with their misfit on all recordings.
void Attributor::fitTogether(std::vector<Explanation> candidates, double without, Reach reach) {
  auto forEach = [&](const std::function<bool(const Explanation&)>& chosen, const std::function<void(Explanation&)>& work) {
    parallelFor(static_cast<int>(candidates.size()), options_.job_count, [&](int i) {
      Explanation& candidate = candidates[static_cast<std::size_t>(i)];
      if (!plant_.interrupted() && chosen(candidate)) work(candidate);
    });
  };
  auto within = [&](double distance) {
    double best = std::numeric_limits<double>::infinity();
    for (const Explanation& candidate : candidates) best = std::min(best, candidate.log_misfit);
    return [limit = best + distance](const Explanation& candidate) { return candidate.log_misfit <= limit; };
  };
  const int rounds = options_.max_effects > few_effects ? many_rounds : last_rounds;
  auto all = [](const Explanation&) { return true; };
  forEach(all, [&](Explanation& candidate) {
    weakenStart(candidate, without);
    refit(candidate, look_, first_rounds, Fidelity::coarse);
  });
  forEach(within(reach.on_look), [&](Explanation& candidate) { refit(candidate, look_, more_rounds, Fidelity::coarse); });
  forEach(all, [&](Explanation& candidate) { refit(candidate, fit_, 0, Fidelity::coarse); });
  forEach(within(reach.on_all), [&](Explanation& candidate) { refit(candidate, fit_, rounds, Fidelity::fine); });
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

void Attributor::fitAlone(const std::vector<std::size_t>& chosen) {
  std::vector<Explanation> candidates;
  for (const std::size_t index : chosen) candidates.push_back({{index}, startOf(index, result_.signatures[index]), {}, {}, 0, 0});
  fitTogether(std::move(candidates), look_.logMisfit(look_residual_), single_reach);
}

/// What looks alike acts on the same component; where there are many, most of it may not have been among the first.
void Attributor::fitMoreOnTheBestComponent() {
  if (result_.explanations.empty()) return;
  const std::string component = result_.suspects[result_.explanations.front().suspects.front()].component();
  std::set<std::string> fitted;
  for (const Explanation& explanation : result_.explanations) {
    const Suspect& suspect = result_.suspects[explanation.suspects.front()];
    if (suspect.component() == component) fitted.insert(suspect.label());
  }
  if (fitted.size() >= component_count) return;
  std::vector<double> log_misfit;
  for (std::size_t s = 0; s < result_.suspects.size(); ++s) {
    const bool other = result_.suspects[s].component() != component || fitted.contains(result_.suspects[s].label());
    log_misfit.push_back(other ? std::numeric_limits<double>::infinity() : result_.signatures[s].log_misfit);
  }
  fitAlone(survivors(log_misfit, component_count - fitted.size(), false));
}

/// A further effect is looked for beside the likeliest explanation of `count` - 1 effects, with the first look's signatures on what that
/// one leaves. Returns whether there was anything to look for.
bool Attributor::fitFurther(std::size_t count) {
  const auto found =
      std::ranges::find_if(result_.explanations, [&](const Explanation& explanation) { return explanation.suspects.size() + 1 == count; });
  if (found == result_.explanations.end()) return false;
  // Of the one that leaves nothing.
  const Explanation& first = firstOf(*found);
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(fit_.size());
  const double best_hope =
      furtherLogOdds(nothing, first) - furtherLogOdds(found->residual, first) - weighing_.per_effect - weighing_.per_parameter;
  if (best_hope < least_hope) return false;
  const Explanation best = *found;
  const Eigen::VectorXd predicted = look_.predicted(modelOf(best));
  if (!predicted.size()) return false;
  const Eigen::VectorXd left = look_.measured() - predicted;
  // Where many effects act, what one changes depends on the others: they are looked at again beside what has been found.
  const bool again = options_.max_effects > few_effects;
  std::vector<Signature> signatures =
      again ? screen(look_, result_.suspects, predicted, modelOf(best), Strengths::kept, options_.job_count, on_simulation_)
            : result_.signatures;
  std::vector<double> log_misfit;
  for (std::size_t s = 0; s < signatures.size(); ++s) {
    if (!again) explain(look_, result_.suspects[s], left, signatures[s]);
    const bool same = std::ranges::any_of(
        best.suspects, [&](std::size_t member) { return result_.suspects[s].info().id == result_.suspects[member].info().id; });
    log_misfit.push_back(same ? std::numeric_limits<double>::infinity() : signatures[s].log_misfit);
  }
  std::vector<Explanation> candidates;
  for (const std::size_t index : survivors(log_misfit, pair_count, false)) {
    const Eigen::VectorXd further = startOf(index, signatures[index]);
    Explanation candidate{best.suspects, Eigen::VectorXd(best.z.size() + further.size()), {}, {}, 0, 0, best.tuning};
    candidate.suspects.push_back(index);
    candidate.z << best.z, further;
    candidates.push_back(std::move(candidate));
  }
  fitTogether(std::move(candidates), look_.logMisfit(left), pair_reach);
  return true;
}

/// Mean square per cell of a share of the residual.
Eigen::VectorXd Attributor::mismatchOf(double share, const Eigen::VectorXd& residual) const {
  Eigen::VectorXd squares(static_cast<Eigen::Index>(fit_.cells().size()));
  for (Eigen::Index i = 0; i < squares.size(); ++i)
    squares[i] = share * share * fit_.meanSquare(fit_.cells()[static_cast<std::size_t>(i)], residual);
  return squares;
}

/// Mean over affected cells of ln(RMS / floor), where floor^2 = noise floor^2 + mismatch, but no less than 0 per cell.
double Attributor::weighedMisfit(const Eigen::VectorXd& residual, const Eigen::VectorXd& mismatch) const {
  double sum = 0;
  for (Eigen::Index i = 0; i < mismatch.size(); ++i) {
    const Comparison::Cell& cell = fit_.cells()[static_cast<std::size_t>(i)];
    sum += 0.5 * std::log(std::max(1.0, fit_.meanSquare(cell, residual) / (cell.floor * cell.floor + mismatch[i])));
  }
  return sum / fit_.affectedCells(nominal_residual_);
}

/// A small share of the gap counts as noise: the right cause's law is not quite ours.
double Attributor::misfitLeftBy(const Eigen::VectorXd& residual) const {
  return weighedMisfit(residual, mismatchOf(weighing_.law_mismatch, nominal_residual_));
}

/// ln of the odds by what further effects leave, but for a constant. It is taken once as of the first effect, and once with a large share
/// of what the first one changes counted as noise: what further effects gain below that may only mend its law.
double Attributor::furtherLogOdds(const Eigen::VectorXd& residual, const Explanation& first) const {
  const double beyond = weighedMisfit(residual, mismatchOf(weighing_.mended_share, nominal_residual_ - first.residual));
  return -weighing_.per_further_gain * misfitLeftBy(residual) - weighing_.per_own_gain * beyond;
}

/// That of its first effect alone.
const Explanation& Attributor::firstOf(const Explanation& explanation) const {
  return *std::ranges::find_if(result_.explanations, [&](const Explanation& other) {
    return other.suspects.size() == 1 && other.suspects.front() == explanation.suspects.front();
  });
}

/// ln of the odds by what is left; of further effects, by what they gain over the first.
double Attributor::misfitLogOdds(const Explanation& explanation) const {
  const Explanation& first = firstOf(explanation);
  return -weighing_.per_misfit * misfitLeftBy(first.residual) + furtherLogOdds(explanation.residual, first) -
         furtherLogOdds(first.residual, first);
}

/// What speaks against an explanation before its misfit is looked at.
double Attributor::priorLogOdds(const Explanation& explanation) const {
  double odds = -weighing_.per_parameter * static_cast<double>(explanation.z.size()) -
                weighing_.per_effect * (static_cast<double>(explanation.suspects.size()) - 1);
  Eigen::Index first = 0;
  for (const std::size_t index : explanation.suspects) {
    const Suspect& suspect = result_.suspects[index];
    odds -= weighing_.per_excess * suspect.excess(explanation.z.segment(first, suspect.coordinateCount()));
    if (suspect.info().stage == Stage::sensor && suspect.component() == "all") odds -= weighing_.shared_sensor;
    first += suspect.coordinateCount();
  }
  return odds;
}

/// Sorts by odds = exp(misfit log odds) * prior odds; "none of these" and "no effect" are explanations like any other.
void Attributor::weigh() {
  if (result_.explanations.empty() && plant_.interrupted()) return;  // nothing is known yet
  const double no_effect = misfitLeftBy(nominal_residual_);
  std::vector<double> odds = {-weighing_.per_misfit * no_effect,
                              -weighing_.per_misfit * weighing_.none_share * no_effect - weighing_.per_parameter};
  for (const Explanation& explanation : result_.explanations) odds.push_back(misfitLogOdds(explanation) + priorLogOdds(explanation));
  const double largest = *std::ranges::max_element(odds);
  double sum = 0;
  for (double& value : odds) sum += value = std::exp(value - largest);
  result_.no_effect = odds[0] / sum;
  result_.none_of_these = odds[1] / sum;
  for (std::size_t i = 0; i < result_.explanations.size(); ++i) result_.explanations[i].probability = odds[i + 2] / sum;
  std::ranges::stable_sort(result_.explanations, [](const Explanation& a, const Explanation& b) { return a.probability > b.probability; });
}

/// The explanation that leaves least, where every effect must be worth its while.
const Explanation& Attributor::nearest() const {
  constexpr double worth_an_effect = 0.05;  // log misfit per affected cell
  return *std::ranges::min_element(result_.explanations, {}, [](const Explanation& explanation) {
    return explanation.log_misfit + worth_an_effect * static_cast<double>(explanation.suspects.size());
  });
}

void Attributor::decide() {
  fitSingles();
  weigh();
  fitMoreOnTheBestComponent();
  weigh();
  for (int count = 2; count <= options_.max_effects && fitFurther(static_cast<std::size_t>(count)); ++count) weigh();
}

}  // namespace musclesim
