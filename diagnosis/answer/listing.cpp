#include "listing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "../../base/parallel.h"
#include "../isolation/actuation_phases.h"
#include "../words/effect_words.h"
#include "../words/sentences.h"
#include "tune.h"

namespace musclesim {

namespace {

constexpr double as_good = 0.05;  ///< explanations with at least this share of the best one's probability cannot be distinguished from it
constexpr double excited = 1;     ///< least change of a signal by a typical effect, in sigmas, for it to be excited

std::string labelOf(const Search& search, std::size_t hypothesis) {
  return search.hypotheses()[hypothesis].label();
}

constexpr double wide = 10;  ///< an interval, over the number or its usual size: nothing is known of its order of magnitude

/// Values and intervals of an effect's parameters; `first` is the index of its first coordinate.
std::map<std::string, Estimate> estimatesOfFit(const Hypothesis& hypothesis, const Explanation& fitted, Eigen::Index first) {
  const Eigen::Index count = hypothesis.coordinateCount();
  const Eigen::VectorXd z = fitted.z.segment(first, count), half = fitted.half_width.segment(first, count);
  const auto at = hypothesis.valuesAt(z), one = hypothesis.valuesAt(hypothesis.clamped(z - half)),
             other = hypothesis.valuesAt(hypothesis.clamped(z + half));
  std::map<std::string, Estimate> result;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto coordinate = static_cast<Eigen::Index>(i);  // parameters that are not fitted come last
    result[at[i].first] = {at[i].second, std::min(one[i].second, other[i].second), std::max(one[i].second, other[i].second),
                           coordinate >= count || std::isfinite(half[coordinate])};
  }
  for (const EffectParameter& parameter : hypothesis.info().parameters)
    if (const auto found = result.find(parameter.name); found != result.end()) {
      Estimate& estimate = found->second;
      if (estimate.high - estimate.low > wide * std::max(usualScale(parameter), std::abs(estimate.value))) estimate.is_determined = false;
    }
  return result;
}

/// The same for a member of an explanation. If it was also fitted with further mechanisms, the intervals hold those of that fit, too.
std::map<std::string, Estimate> estimates(const Search& search, const Explanation& fitted, std::size_t member) {
  const auto of = [&](const Explanation& one) {
    return estimatesOfFit(search.hypotheses()[one.members[member]], one, search.causes().firstCoordinate(one, member));
  };
  std::map<std::string, Estimate> result = of(fitted);
  if (!fitted.with_mechanisms) return result;
  for (const auto& [name, other] : of(*fitted.with_mechanisms))
    if (const auto own = result.find(name); own != result.end()) {
      own->second.low = std::min(own->second.low, other.low);
      own->second.high = std::max(own->second.high, other.high);
      own->second.is_determined = own->second.is_determined && other.is_determined;
    }
  return result;
}

/// How much less likely the readings are with `residual` than with `best`, in nats, if what they leave is white noise. The noise of a block
/// is its floor, or what `best` leaves there if that is more.
double lessLikelyNats(const Comparison& comparison, const Eigen::VectorXd& residual, const Eigen::VectorXd& best) {
  double nats = 0;
  for (const Comparison::Block& block : comparison.blocks()) {
    if (!block.isReading()) continue;
    const double least = comparison.meanSquare(block, best);
    nats += 0.5 * static_cast<double>(block.count()) * (comparison.meanSquare(block, residual) - least) /
            std::max(least, block.sigma * block.sigma);
  }
  return nats;
}

/// Widens the intervals of times that can change by up to an internal step of the model without a noticeable loss: a limited flow moves on
/// by whole steps, so that nothing changes with the dead time before it as long as that stays within one. Derivatives do not show the ends
/// of such a plateau.
void widenWithinStep(const Search& search, const Explanation& fitted, std::size_t member, std::map<std::string, Estimate>& estimates) {
  constexpr double noticeable_nats = 1.92;  // half of the 95 % quantile of chi square with one degree of freedom
  constexpr int parts = 4;                  // of an internal step
  const Comparison& comparison = search.fitComparison();
  if (fitted.residual.size() != comparison.size()) return;  // interrupted before it was fitted to all recordings
  const Plant& plant = search.causes().plant();
  const double step_s = plant.model().internalStepS() * plant.model().substeps() / plant.substeps(), part_s = step_s / parts;
  const auto isNoticeable = [&](const std::string& parameter, double value) {
    Model model = search.modelOf(fitted);
    model.effects[member].parameters[parameter] = value;
    const Eigen::VectorXd predicted = comparison.predicted(model, Fidelity::fine);
    return search.causes().plant().interrupted() || !predicted.size() ||
           lessLikelyNats(comparison, comparison.measured() - predicted, fitted.residual) > noticeable_nats;
  };
  for (const EffectParameter& parameter : search.hypotheses()[fitted.members[member]].info().parameters) {
    const auto found = estimates.find(parameter.name);
    if (parameter.unit != "s" || found == estimates.end() || !found->second.is_determined) continue;
    Estimate& time = found->second;
    for (const double part : {-part_s, part_s}) {
      int moved = 0;  // parts to the first noticeable one
      while (moved < parts &&
             !isNoticeable(parameter.name, std::clamp(time.value + (moved + 1) * part, parameter.minimum, parameter.maximum)))
        ++moved;
      const double last = time.value + moved * part;
      if (last >= time.low && last <= time.high) continue;
      const double end = std::clamp(last + (moved < parts ? part : 0), parameter.minimum, parameter.maximum);  // the plateau ends before
      time.low = std::min(time.low, end);
      time.high = std::max(time.high, end);
    }
  }
}

/// What each chosen effect removes while the others are present.
std::map<std::string, double> shares(const Search& search, const HeldOut& held_out, const Diagnosis& diagnosis) {
  std::map<std::string, double> result;
  if (diagnosis.chosen.empty()) return result;
  const Explanation& chosen = search.explanations().front();
  for (std::size_t m = 0; m < chosen.members.size(); ++m) {
    const Eigen::VectorXd residual = held_out.comparison.residualOf(search.modelOf(search.causes().without(chosen, m)));
    if (!residual.size()) continue;
    result[labelOf(search, chosen.members[m])] = diagnosis.reduction_percent - held_out.reductionPercent(residual);
  }
  return result;
}

std::optional<double> singleReduction(const Search& search, const HeldOut& held_out, const std::string& label) {
  if (search.causes().plant().interrupted()) return std::nullopt;
  for (const Explanation& fitted : search.singles()) {
    if (labelOf(search, fitted.members.front()) != label) continue;
    const Eigen::VectorXd residual = held_out.comparison.residualOf(search.modelOf(fitted));
    if (residual.size()) return held_out.reductionPercent(residual);
  }
  return std::nullopt;
}

/// The gap with the chosen effects added one after another, the one that removes most alone first.
std::vector<RemovalStep> removalSteps(const Search& search, const HeldOut& held_out, const Diagnosis& diagnosis) {
  std::vector<RemovalStep> steps;
  if (diagnosis.chosen.size() < 2 || search.causes().plant().interrupted()) return steps;
  const auto alone = [&](const std::string& label) {
    const auto effect = std::ranges::find_if(diagnosis.effects, [&](const FoundEffect& found) { return found.label() == label; });
    return effect == diagnosis.effects.end() ? 0 : effect->reduction_percent.value_or(0);
  };
  std::vector<std::string> order = diagnosis.chosen;
  std::ranges::stable_sort(order, std::greater{}, alone);
  Explanation rest = search.explanations().front();
  double left_percent = 100 - diagnosis.reduction_percent;
  while (!rest.members.empty()) {
    const std::string last = order[rest.members.size() - 1];
    const auto member = std::ranges::find_if(rest.members, [&](std::size_t index) { return labelOf(search, index) == last; });
    if (member == rest.members.end()) return {};
    steps.insert(steps.begin(), {last, left_percent});
    rest = search.causes().without(rest, static_cast<std::size_t>(member - rest.members.begin()));
    if (rest.members.empty()) break;
    const Eigen::VectorXd predicted = held_out.comparison.predicted(search.modelOf(rest));
    if (!predicted.size()) return {};
    left_percent = 100 - held_out.reductionPercent(held_out.comparison.measured() - predicted);
  }
  return steps;
}

void listAmbiguity(const Search& search, Diagnosis& diagnosis) {
  const std::vector<const Explanation*> likely = asGood(search);
  for (const Explanation* fitted : likely) {
    const std::set<std::string> labels = search.causes().labelsOf(fitted->members);
    diagnosis.ambiguity_sets.emplace_back(labels.begin(), labels.end());
  }
  for (const Explanation* fitted : likely)
    if (likely.size() > 1) diagnosis.alternatives.push_back(wordsOf(search, *fitted));
  for (const Explanation* fitted : likely)
    for (const std::size_t index : fitted->members)
      if (std::ranges::find(diagnosis.ambiguity_set, labelOf(search, index)) == diagnosis.ambiguity_set.end())
        diagnosis.ambiguity_set.push_back(labelOf(search, index));
}

}  // namespace

std::vector<const Explanation*> asGood(const Search& search) {
  std::vector<const Explanation*> result;
  const auto& all = search.explanations();
  for (const Explanation& fitted : all)
    if (fitted.probability > 0 && fitted.probability >= as_good * search.likeliest().probability) result.push_back(&fitted);
  return result;
}

std::string wordsOf(const Search& search, const Explanation& explanation) {
  return fmt::format("{}", fmt::join(search.causes().labelsOf(explanation.members), " + "));
}

void listNotExcited(const Search& search, Diagnosis& diagnosis) {
  std::set<std::string> shown = search.catalogue().thinned;
  for (std::size_t i = 0; i < search.hypotheses().size(); ++i)
    if (!(search.catalogue().sensitivities[i].excitation_ratio.value_or(excited) < excited)) shown.insert(labelOf(search, i));
  for (std::size_t i = 0; i < search.hypotheses().size(); ++i) {
    const bool would_be_seen = search.hypotheses()[i].info().id == held_effect;
    if (search.catalogue().allowed[i] && !would_be_seen && shown.insert(labelOf(search, i)).second)
      diagnosis.not_excited.push_back(labelOf(search, i));
  }
}

void listEffects(const Search& search, const HeldOut& held_out, const DiagnosisOptions& options, Diagnosis& diagnosis) {
  const double known = 1 - diagnosis.none_of_these;  // probability that the catalogue holds the cause
  const double no_effect = known * search.nothing().probability;
  if (no_effect >= least_listed) diagnosis.explanations.push_back({{}, no_effect});
  const std::map<std::string, double> removed =
      search.causes().plant().interrupted() ? std::map<std::string, double>() : shares(search, held_out, diagnosis);
  std::map<std::string, FoundEffect> found;
  for (const Explanation& fitted : search.explanations()) {
    ExplanationProbability entry{{}, known * fitted.probability};
    for (std::size_t member = 0; member < fitted.members.size(); ++member) {
      const Hypothesis& hypothesis = search.hypotheses()[fitted.members[member]];
      entry.effects.push_back(hypothesis.label());
      FoundEffect& effect = found[hypothesis.label()];
      if (effect.id.empty()) {
        effect.id = hypothesis.info().id;
        effect.component = hypothesis.component();
        effect.parameters = estimates(search, fitted, member);
        if (entry.probability >= least_listed) widenWithinStep(search, fitted, member, effect.parameters);
        effect.choices = hypothesis.choices();
        if (const auto share = removed.find(hypothesis.label()); share != removed.end()) effect.removes_percent = share->second;
      }
      effect.probability += known * fitted.probability;
    }
    if (known * fitted.probability >= least_listed) diagnosis.explanations.push_back(std::move(entry));
  }
  for (auto& [label, effect] : found)
    if (effect.probability >= least_listed) diagnosis.effects.push_back(effect);
  std::ranges::stable_sort(diagnosis.effects, std::greater{}, &FoundEffect::probability);
  std::ranges::stable_sort(diagnosis.explanations, std::greater{}, &ExplanationProbability::probability);
  listAmbiguity(search, diagnosis);
  // An effect that was found is excited, though not at its typical strength.
  std::erase_if(diagnosis.not_excited, [&](const std::string& label) {
    const auto& tried = diagnosis.attempt.effects;
    return (found.contains(label) && found[label].probability >= least_listed) || std::ranges::find(tried, label) != tried.end();
  });
  parallelFor(static_cast<int>(diagnosis.effects.size()), options.job_count, [&](int i) {
    FoundEffect& effect = diagnosis.effects[static_cast<std::size_t>(i)];
    effect.reduction_percent = singleReduction(search, held_out, effect.label());
  });
  diagnosis.removal = removalSteps(search, held_out, diagnosis);
}

void listTrials(const Search& search, Diagnosis& diagnosis) {
  const Plant& plant = search.causes().plant();
  const double whole = search.screeningComparison().misfit(search.screeningResidual());
  for (std::size_t i = 0; i < search.hypotheses().size(); ++i)
    if (search.catalogue().allowed[i])
      diagnosis.screenings.push_back({labelOf(search, i), whole > 0 ? 1 - search.catalogue().sensitivities[i].misfit / whole : 0});
  std::ranges::stable_sort(diagnosis.screenings, [](const auto& a, const auto& b) { return a.removed > b.removed; });
  const Comparison& comparison = search.fitComparison();
  auto rmsOf = [&](const Eigen::VectorXd& residual) {
    std::vector<double> rms;
    for (const Comparison::Block& block : comparison.blocks()) rms.push_back(std::sqrt(comparison.meanSquare(block, residual)));
    return rms;
  };
  const std::vector<double> before = rmsOf(search.nominalResidual());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Comparison::Block& block = comparison.blocks()[i];
    const auto recording = static_cast<std::size_t>(comparison.segments()[block.segment].recording);
    diagnosis.blocks.push_back({plant.recordings()[recording].file, plant.signals()[static_cast<std::size_t>(block.signal)].name,
                                block.sigma, before[i], static_cast<int>(block.averaged_rows), block.is_parity});
  }
  std::vector<Explanation> all = search.explanations();
  all.push_back(search.nothing());
  for (const Explanation& fitted : all) {
    if (fitted.residual.size() != comparison.size()) continue;
    const Evidence evidence = search.evidence();
    const auto misfits = comparison.misfits(fitted.residual);
    const auto complexity = evidence.complexityOf(fitted).asArray();
    Trial trial{{},
                static_cast<int>(fitted.z.size()),
                rmsOf(fitted.residual),
                {misfits.begin(), misfits.end()},
                {complexity.begin(), complexity.end()},
                costOfNumbers(fitted.numbers),
                fitted.score,
                {}};
    Eigen::Index first = 0;
    for (const std::size_t index : fitted.members) {
      const Hypothesis& hypothesis = search.hypotheses()[index];
      trial.effects.push_back(hypothesis.label());
      auto& values = trial.values.emplace_back();
      for (const auto& [name, value] : hypothesis.valuesAt(fitted.z.segment(first, hypothesis.coordinateCount()))) values[name] = value;
      first += hypothesis.coordinateCount();
    }
    diagnosis.trials.push_back(std::move(trial));
  }
}

void listNumbers(const Plant& plant, const Explanation& fitted, Diagnosis& diagnosis) {
  for (Eigen::Index i = 0; i < fitted.numbers.size(); ++i) {
    const auto& [parameter, tolerance, is_tuned] = plant.numbers()[static_cast<std::size_t>(i)];
    if (is_tuned || fitted.numbers_half_width.size() <= i) continue;
    const double eta = fitted.numbers[i], half = fitted.numbers_half_width[i];
    diagnosis.numbers.push_back({parameter.name,
                                 parameter.unit,
                                 std::get<double>(parameter.value),
                                 {plant.numberAt(i, eta), plant.numberAt(i, eta - half), plant.numberAt(i, eta + half), true},
                                 eta});
  }
  diagnosis.tuned = tunedParameters(plant, fitted.numbers, fitted.numbers_half_width);
}

namespace {

/// Whether no signal stands out of its noise and what the step size changes in it.
bool isWithinSteps(const Gap& left, const Unsteady& unsteady) {
  return !unsteady.signal.empty() && std::ranges::all_of(left.per_signal, [&](const auto& entry) {
    const auto change = unsteady.all_in_sigmas.find(entry.first);
    return overNoise(entry.second) < out_of_noise * std::hypot(1, change == unsteady.all_in_sigmas.end() ? 0 : change->second);
  });
}

/// Names the signal in which the rest stands out most, and its stage.
void describeRemainder(const Search& search, const HeldOut& held_out, const Eigen::VectorXd& after, Diagnosis& diagnosis) {
  if (!after.size() || diagnosis.before.normalised <= 0) return;
  const Gap left = held_out.comparison.gap(after);
  Remainder& remainder = diagnosis.remainder;
  const bool stands_out = !isWithinNoise(held_out.comparison, after);
  remainder.is_within_steps = stands_out && isWithinSteps(left, diagnosis.unsteady);
  remainder.is_significant = stands_out && !remainder.is_within_steps;
  remainder.percent_of_gap = 100 * left.normalised / diagnosis.before.normalised;
  remainder.probability = search.somethingElse();
  for (const auto& [signal, gap] : left.per_signal)
    if (const double in_sigmas = overNoise(gap); in_sigmas > remainder.in_sigmas) {
      remainder.in_sigmas = in_sigmas;
      remainder.signal = signal;
      remainder.stage = nameOf(signal.starts_with("pressure_") ? Stage::pressure
                               : signal.starts_with("force_")  ? Stage::force
                                                               : Stage::body);
    }
  remainder.shape = shapeOfRest(diagnosis, remainder.signal);
  if (const std::string phase = phaseOf(held_out.comparison, after); !phase.empty())
    remainder.shape += (remainder.shape.empty() ? "mostly while " : ", most while ") + phase;
}

void addPhases(const HeldOut& held_out, const Eigen::VectorXd& after_residual, Diagnosis& diagnosis) {
  if (!held_out.before.size()) return;
  const PhaseSums before = phaseSums(held_out.comparison, held_out.before),
                  after = after_residual.size() ? phaseSums(held_out.comparison, after_residual) : PhaseSums{};
  for (const ActuationPhase phase : {ActuationPhase::filling, ActuationPhase::venting, ActuationPhase::holding})
    if (before.rows[static_cast<std::size_t>(phase)] > 0)
      diagnosis.phases.push_back({nameOf(phase), std::sqrt(before.meanSquare(phase)), std::sqrt(after.meanSquare(phase))});
}

void addTraces(const Plant& plant, const HeldOut& held_out, const Eigen::VectorXd& after, Diagnosis& diagnosis) {
  for (const Comparison::Block& block : held_out.comparison.blocks()) {
    const int recording = held_out.comparison.segments()[block.segment].recording;
    Trace trace{plant.recordings()[static_cast<std::size_t>(recording)].file,
                plant.signals()[static_cast<std::size_t>(block.signal)].name,
                {},
                {},
                {},
                {}};
    for (std::size_t i = 0; i < block.rows.size(); ++i) {
      const auto k = block.first + static_cast<Eigen::Index>(i);
      trace.time_s.push_back(plant.recordings()[static_cast<std::size_t>(recording)].time_s[static_cast<std::size_t>(block.rows[i])]);
      trace.measured.push_back(held_out.comparison.measured()[k]);
      trace.before.push_back(held_out.comparison.measured()[k] - held_out.before[k]);
      if (after.size()) trace.after.push_back(held_out.comparison.measured()[k] - after[k]);
    }
    diagnosis.traces.push_back(std::move(trace));
  }
}

}  // namespace

void listHeldOut(const Search& search, const HeldOut& held_out, const Eigen::VectorXd& after, Diagnosis& diagnosis) {
  addPhases(held_out, after, diagnosis);
  addTraces(search.causes().plant(), held_out, after, diagnosis);
  describeRemainder(search, held_out, after, diagnosis);
}

}  // namespace musclesim
