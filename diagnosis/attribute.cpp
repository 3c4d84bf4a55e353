#include "attribute.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "parallel.h"

namespace musclesim {

namespace {

constexpr std::size_t many_suspects = 200;   ///< with more, most are looked at on the first stretch of the look only
constexpr std::size_t nearest_count = 80;    ///< suspects that are looked at on all of it then
constexpr std::size_t per_effect_count = 3;  ///< and at least so many of every effect
constexpr std::size_t single_count = 14;     ///< suspects that are fitted
constexpr std::size_t component_count = 8;   ///< suspects on the component of the best that are fitted
constexpr std::size_t pair_count = 6;        ///< further effects that are fitted beside the best
constexpr std::size_t base_count = 3;        ///< explanations beside which further effects are looked for
constexpr std::size_t fewer_pairs = 3;       ///< further effects that are fitted beside the second and third of them
constexpr double likely_share = 0.1;         ///< of the best one's probability, that those have at least
constexpr double least_hope = -1;            ///< ln of the odds of one more effect that leaves nothing; below, none is looked for
constexpr int few_effects = 2;               ///< up to that many, the first look serves for all of them
constexpr int first_rounds = 2, last_rounds = 2;
constexpr int many_rounds = 12;  ///< in place of the last rounds where many effects act together
constexpr Reach single_reach = {{0.8, 0.5}, {0.4, 0.15}}, pair_reach = {{0.25, 0}, {0.1, 0}};

}  // namespace

Attributor::Attributor(const Plant& plant, const DiagnosisOptions& options, OnSimulation on_simulation)
    : plant_(plant),
      options_(options),
      on_simulation_(std::move(on_simulation)),
      look_(plant, plant.lookStretches(), Comparison::Averages::with),
      fit_(plant, plant.split().fit, Comparison::Averages::with) {}

Comparison Attributor::firstOfLook() const {
  Comparison result(plant_, {look_.stretches().front()}, Comparison::Averages::with);
  result.goCoarse(result.predicted(Model{}), Comparison::Purpose::looking);
  return result;
}

/// Of variants without any strength (numbers of bits), those of one component that leave least on the first stretch of the look: simulating
/// all of them on all of it would take as long as everything else.
void Attributor::keepNearestVariants() {
  constexpr std::size_t kept = 2;
  const Comparison brief = firstOfLook();
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

/// The suspects that are looked at on all of the look. Where there are many - ten muscles have ten of most kinds - those that explain most
/// of its first stretch, and some of every effect. That does not depend on what may be an answer: nor does where the gap lies.
std::vector<std::size_t> Attributor::worthLookingAt() const {
  const std::vector<Suspect>& all = result_.suspects;
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), 0);
  if (all.size() <= many_suspects || look_.stretches().size() < 2) return order;
  const Comparison brief = firstOfLook();
  std::vector<Suspect> suspects = all;
  const std::vector<Signature> looks =
      screen(brief, suspects, brief.predicted(Model{}), Model{}, Strengths::adapted, options_.job_count, on_simulation_);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return looks[i].log_misfit; });
  std::map<std::string, std::size_t> per_effect;
  std::vector<std::size_t> chosen;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const bool among_first_of_effect = per_effect[all[order[rank]].info().id]++ < per_effect_count;
    if (rank < nearest_count || among_first_of_effect) chosen.push_back(order[rank]);
  }
  std::ranges::sort(chosen);
  return chosen;
}

void Attributor::lookAtSuspects(const Eigen::VectorXd& nominal) {
  const std::vector<std::size_t> chosen = worthLookingAt();
  std::vector<Suspect> suspects;
  for (const std::size_t i : chosen) suspects.push_back(result_.suspects[i]);
  std::vector<Signature> looks = screen(look_, suspects, nominal, Model{}, Strengths::adapted, options_.job_count, on_simulation_);
  for (const Suspect& suspect : result_.suspects) {
    Signature unknown;
    unknown.per_strength.resize(std::max<std::size_t>(1, suspect.strengths().size()));
    explain(look_, suspect, look_residual_, unknown);
    result_.signatures.push_back(std::move(unknown));
  }
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    result_.suspects[chosen[k]] = std::move(suspects[k]);
    result_.signatures[chosen[k]] = std::move(looks[k]);
  }
  result_.looked_at_count = chosen.size();
}

/// What shows nothing in the stretches of the look may show in the rest of the recordings.
void Attributor::lookForExcitation(const std::vector<Suspect>& typical) {
  const std::vector<Stretch>&looked = look_.stretches(), &fitted = fit_.stretches();
  const bool is_all = looked.size() == fitted.size() && std::ranges::equal(looked, fitted, {}, &Stretch::end_row, &Stretch::end_row);
  if (is_all) return;
  const Eigen::VectorXd nominal = fit_.measured() - nominal_residual_;
  std::vector<std::size_t> hidden;
  for (std::size_t i = 0; i < typical.size(); ++i)
    if (result_.allowed[i] && result_.signatures[i].excitation_ratio.value_or(1) < 1) hidden.push_back(i);
  parallelFor(static_cast<int>(hidden.size()), options_.job_count, [&](int i) {
    const std::size_t index = hidden[static_cast<std::size_t>(i)];
    if (plant_.interrupted()) return;
    const Suspect& suspect = typical[index];
    const Eigen::VectorXd predicted = fit_.predicted(Model{{suspect.at(suspect.typical())}, {}});
    if (predicted.size() == nominal.size() && predicted.allFinite())
      result_.signatures[index].excitation_ratio = excitationOf(fit_, {predicted - nominal});
    on_simulation_();
  });
}

void Attributor::look() {
  const Eigen::VectorXd nominal = look_.predicted(Model{});
  if (!nominal.size()) throw Diverged(0, plant_.robot(), "the model without further effects cannot follow the recordings");
  look_residual_ = look_.measured() - nominal;
  const Eigen::VectorXd everywhere = fit_.predicted(Model{});
  nominal_residual_ = fit_.measured() - everywhere;
  look_.goCoarse(nominal, Comparison::Purpose::looking);
  fit_.goCoarse(everywhere);
  result_.suspects = suspects(plant_, DiagnosisOptions{});
  keepNearestVariants();
  for (const Suspect& suspect : result_.suspects) result_.allowed.push_back(allows(options_, suspect.info().id));
  const std::vector<Suspect> typical = result_.suspects;
  lookAtSuspects(nominal);
  lookForExcitation(typical);
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
  constexpr double far_behind = 9;  // ln of the odds; what a fit in fine steps may still gain
  if (explanation.suspects.size() == 1) return true;
  double best = -std::numeric_limits<double>::infinity();
  for (const Explanation& other : result_.explanations) best = std::max(best, odds().ofExplanation(other));
  return explanation.residual.size() == fit_.size() && odds().ofExplanation(explanation) > best - far_behind;
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
  forEach([&, within = limit(reach.on_look)](
              const Candidate& candidate) { return candidate.explanation.log_misfit <= within && gainsOnLook(candidate); },
          [&](Candidate& candidate) { refit(candidate.explanation, look_, more_rounds, Fidelity::coarse); });
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

void Attributor::fitAlone(const std::vector<std::size_t>& chosen) {
  const double without = look_.logMisfit(look_residual_);
  std::vector<Candidate> candidates;
  for (const std::size_t index : chosen)
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
      const auto same = [&](const Candidate& other) { return sameEffects(other.explanation, candidate.explanation); };
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
  for (const std::size_t index : survivors(log_misfit, most, false)) {
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
