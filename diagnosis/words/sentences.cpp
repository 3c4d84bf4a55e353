#include "sentences.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "../data/noise_sigma.h"
#include "../data/residual_shape.h"
#include "fitted_numbers.h"
#include "musclesim/effect/catalogue.h"

namespace musclesim {

namespace {

/// "a = 1.0 (0.9 to 1.1), b = 2 (1 to 3)", without parameters that the data left out.
std::string parameterWords(const FoundEffect& effect) {
  std::vector<std::string> words;
  for (const auto& [name, word] : effect.choices) words.push_back(fmt::format("{} = {}", name, word));
  for (const auto& [name, estimate] : effect.parameters)
    if (!isLeftOut(estimate)) words.push_back(fmt::format("{} = {}", name, estimateWords(estimate)));
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

std::string effectSentence(const FoundEffect& effect) {
  const std::string parameters = parameterWords(effect);
  return effect.label() + (parameters.empty() ? "" : ": " + parameters);
}

std::string muscleNameWords(const Diagnosis& d) {
  std::vector<std::string> words;
  for (const std::string& name : d.muscle_names) words.push_back(fmt::format("{} {}", words.size(), name));
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string elsewhereSentence(const Estimate& reduction_percent) {
  if (reduction_percent.low > nearly_all) return "On another recording of this plant the same is expected.";
  // An interval that extends below 0 says something about the recordings, not about the effect.
  if (reduction_percent.low < 0) return "The recordings are too few or too different to predict how much is removed on another one.";
  return fmt::format("On another recording of this plant, {:.1f} to {:.1f} % is expected to be removed (95 % interval).",
                     reduction_percent.low, reduction_percent.high);
}

std::string componentWords(const std::string& component) {
  if (component == "all") return "all components";
  std::string words = component;
  std::ranges::replace(words, '_', ' ');
  return words;
}

double overNoise(const SignalGap& gap) {
  return gap.noise_sigma > 0 ? gap.rmse / gap.noise_sigma : 0;
}

std::string shapeOfRest(const Diagnosis& d, const std::string& signal) {
  const Gap& rest = d.attempt.effects.empty() ? d.after : d.attempt.after;
  const auto gap = rest.per_signal.find(signal);
  const auto trace = std::ranges::find(d.traces, signal, &Trace::signal);
  if (gap == rest.per_signal.end() || trace == d.traces.end() || overNoise(gap->second) < stands_out_of_noise) return "";
  return wordsFor(describeResidual(trace->time_s, trace->measured, trace->after.empty() ? trace->before : trace->after));
}

namespace {

/// Whether the first place is more probable than all others together.
bool isTold(const std::vector<Place>& where) {
  constexpr double told_share = 0.5;
  return !where.empty() && where.front().share >= told_share;
}

/// The stages after the first that the signals do not contradict.
std::vector<std::string> othersPossible(const std::vector<Place>& where) {
  std::vector<std::string> others;
  for (auto place = where.begin() + 1; place != where.end(); ++place)
    if (!place->is_ruled_out) others.push_back(place->stage);
  return others;
}

bool isBeforeTheForce(const std::string& stage) {
  return stage == nameOf(Stage::command) || stage == nameOf(Stage::pressure);
}

}  // namespace

bool isNoticeable(const Unsteady& unsteady) {
  constexpr double share_of_gap = 0.1;
  return unsteady.share_of_gap >= share_of_gap;
}

bool isLocated(const std::vector<Place>& where) {
  if (!isTold(where) || where.front().is_ruled_out) return false;
  const std::vector<std::string> others = othersPossible(where);
  // A pressure follows its command, so the stages before the force count as one place.
  return isBeforeTheForce(where.front().stage) ? std::ranges::all_of(others, isBeforeTheForce) : others.empty();
}

bool mayBeAt(const std::vector<Place>& where, const std::string& stage) {
  const auto place = std::ranges::find(where, stage, &Place::stage);
  return isLocated(where) && (place == where.begin() || (place != where.end() && !place->is_ruled_out));
}

std::string likelihoodOfOthers(const Diagnosis& d) {
  const auto isChosen = [&](const ExplanationProbability& one) { return std::ranges::is_permutation(one.effects, d.chosen); };
  const auto named = std::ranges::find_if(d.explanations, isChosen);
  const bool is_reached = named != d.explanations.end() && std::ranges::any_of(d.explanations, [&](const ExplanationProbability& other) {
                            return !isChosen(other) && other.probability >= named->probability;
                          });
  return is_reached ? "Also possible" : "Less likely, but possible";
}

bool isFoundAt(const Diagnosis& d, const std::string& stage) {
  return std::ranges::any_of(d.chosen,
                             [&](const std::string& label) { return nameOf(effectInfo(label.substr(0, label.find('@'))).stage) == stage; });
}

namespace {

/// ", mostly while venting" if the held-out data, whose bars the page shows, agree.
std::string phaseWords(const Diagnosis& d) {
  const std::string& phase = d.where.front().phase;
  const auto largest = std::ranges::max_element(d.phases, {}, &PhaseGap::before);
  if (phase.empty() || (largest != d.phases.end() && largest->phase != phase)) return "";
  return ", mostly while " + phase;
}

}  // namespace

std::string whereSentence(const Diagnosis& d) {
  const Place& place = d.where.front();
  const std::string phase = phaseWords(d), component = componentWords(place.component);
  const double percent = 100 * place.share;
  if (!isTold(d.where) && d.where.size() > 1) {
    const Place& next = d.where[1];
    return fmt::format(
        "These signals do not show at which stage the gap arises; the most likely are {} ({}, {:.0f} %) and {} ({}, {:.0f} %){}",
        place.stage, component, percent, next.stage, componentWords(next.component), 100 * next.share, phase);
  }
  const std::vector<std::string> others = othersPossible(d.where);
  // The signals show the largest part; a cause that was found elsewhere makes another.
  const bool is_all = std::ranges::all_of(
      d.chosen, [&](const std::string& label) { return mayBeAt(d.where, nameOf(effectInfo(label.substr(0, label.find('@'))).stage)); });
  const std::string gap = is_all ? "The gap" : "Most of the gap";
  if (isLocated(d.where) && others.empty())
    return fmt::format("{} arises in the {} stage ({}, {} likely){}", gap, place.stage, component, probabilityWords(place.share), phase);
  if (isLocated(d.where))
    return fmt::format("{} arises before the force stage, in command or pressure ({}; its shape favours {}, {} likely){}", gap, component,
                       place.stage, probabilityWords(place.share), phase);
  constexpr std::size_t all_others = 4;
  const std::string against = place.is_ruled_out ? ", although the signals contradict it" : "";
  return fmt::format("The shape of the gap favours the {} stage ({}, {:.0f} %){}{}; the signals do not rule out {}", place.stage, component,
                     percent, phase, against,
                     others.size() == all_others ? "any other stage" : fmt::format("{}", fmt::join(others, " or ")));
}

namespace {

/// " (94.0 to 97.5)" if the recordings allow a prediction for another one.
std::string intervalWords(const Diagnosis& d) {
  if (d.reduction_low_percent > nearly_all || d.reduction_low_percent < 0) return "";
  return fmt::format(" ({:.1f} to {:.1f})", d.reduction_low_percent, d.reduction_high_percent);
}

constexpr double likely = 0.5;  ///< a candidate above this probability must have failed on the held-out data

/// "valve lag on muscle 1".
std::string labelWords(const std::string& label) {
  std::string words = label.substr(0, label.find('@'));
  std::ranges::replace(words, '_', ' ');
  return words + " on " + componentWords(label.substr(label.find('@') + 1));
}

std::string effectWords(const Diagnosis& d, const std::string& label) {
  const auto found = std::ranges::find_if(d.effects, [&](const FoundEffect& effect) { return effect.label() == label; });
  std::string words = labelWords(label);
  if (found == d.effects.end()) return words;
  const std::string parameters = parameterWords(*found);
  return parameters.empty() ? words : words + " with " + parameters;
}

/// "valve lag on muscle 1 together with payload on hand"; "creep on muscle 1, leak on muscle 1 and payload on hand together".
std::string listWords(const std::vector<std::string>& labels) {
  std::vector<std::string> words;
  for (const std::string& label : labels) words.push_back(labelWords(label));
  if (words.size() < 3) return fmt::format("{}", fmt::join(words, " together with "));
  return fmt::format("{} and {} together", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

/// Which numbers that were taken as exact would do what a named effect does.
std::string numbersInsteadWords(const Diagnosis& d) {
  std::vector<std::string> clauses;
  for (auto first = d.numbers_instead.begin(); first != d.numbers_instead.end();) {
    const auto last = std::find_if(first, d.numbers_instead.end(), [&](const NumberInstead& one) { return one.effects != first->effects; });
    std::vector<std::string> values;
    for (auto one = first; one != last; ++one)
      values.push_back(
          fmt::format("{} = {:.4g}{}{} (given as {:.4g})", one->name, one->instead, one->unit.empty() ? "" : " ", one->unit, one->given));
    clauses.push_back(fmt::format("{} would do what {} {}", fmt::join(values, " or "), listWords(first->effects),
                                  first->effects.size() == 1 ? "does" : "do"));
    first = last;
  }
  if (clauses.empty()) return "";
  return fmt::format(
      "Numbers that were taken as exact may be the cause instead: {}. Give those that are not known so well a parameter_tolerance in the "
      "sidecar.",
      fmt::join(clauses, "; "));
}

/// One effect or two with their parameters. Those of more would hide what the sentence says; they are listed elsewhere.
std::string chosenWords(const Diagnosis& d) {
  if (d.chosen.size() > 2) return listWords(d.chosen);
  std::vector<std::string> words;
  for (const std::string& label : d.chosen) words.push_back(effectWords(d, label));
  return fmt::format("{}", fmt::join(words, " together with "));
}

/// A sentence about a residual that stands far out of the noise, which no explanation should hide. RMS / sigma = sqrt(1 + normalised gap).
std::string remainder(const Diagnosis& d, const Gap& after) {
  const double over_noise = std::sqrt(1 + after.normalised);
  if (over_noise < stands_out_of_noise) return "";
  const auto most = std::ranges::max_element(after.per_signal, {}, [](const auto& entry) { return overNoise(entry.second); });
  const std::string where =
      most == after.per_signal.end() ? "" : fmt::format(" ({:.1f} times in {})", overNoise(most->second), most->first);
  if (d.remainder.is_within_steps)
    return fmt::format("The residual is {:.1f} times the noise{}, but no more than {} change: it does not speak for another effect.",
                       over_noise, where,
                       d.unsteady.by == Unsteady::Change::steps ? "internal steps twice as long" : "muscles that pull 0.1 % harder");
  const bool together = d.chosen.size() > 1 || d.attempt.effects.size() > 1;
  return fmt::format("The residual is still {:.1f} times the noise{}{}: another effect acts as well, or {} follows another law.",
                     over_noise, where, d.remainder.shape.empty() ? "" : ", " + d.remainder.shape, together ? "one of these" : "this one");
}

/// "valve lag on muscle 1 together with payload on hand" of "valve_lag@muscle_1 + payload@hand".
std::string explanationWords(const std::string& labels) {
  const std::string link = " + ";
  std::vector<std::string> each;
  for (std::size_t first = 0, end = 0; end != std::string::npos; first = end + link.size()) {
    end = labels.find(link, first);
    each.push_back(labels.substr(first, end - first));
  }
  return listWords(each);
}

/// What the next experiment distinguishes, and how clearly.
std::string separatedWords(const Diagnosis& d) {
  const std::vector<std::string>& separates = d.next_experiment.separates;
  std::string words = "them apart";
  if (separates.size() > 2 && separates.size() < d.alternatives.size()) {
    words = "the likeliest of them apart";
  } else if (separates.size() < d.alternatives.size()) {
    std::vector<std::string> others;
    for (auto other = separates.begin() + 1; other != separates.end(); ++other) others.push_back(explanationWords(*other));
    words = fmt::format("{} from {}", explanationWords(separates.front()), fmt::join(others, " and "));
  }
  if (d.next_experiment.difference < 1)
    words += fmt::format(", although even then {} differ by only {:.1f} times the noise",
                         separates.size() > 2 ? "the two most similar" : "they", d.next_experiment.difference);
  return words;
}

/// The alternatives, and how to distinguish them.
std::string otherwise(const Diagnosis& d) {
  constexpr std::ptrdiff_t most_named = 2;
  if (d.alternatives.size() < 2) return "";
  std::vector<std::string> others;
  const auto first = d.alternatives.begin() + 1, end = first + std::min(most_named, d.alternatives.end() - first);
  for (auto other = first; other != end; ++other) others.push_back(explanationWords(*other));
  const bool pairs = std::ranges::any_of(d.alternatives, [](const std::string& labels) { return labels.find(" + ") != std::string::npos; });
  std::string experiment;
  if (!d.next_experiment.commands.empty()) experiment = "; record the schedule in next.csv to tell " + separatedWords(d);
  const auto more = static_cast<std::size_t>(d.alternatives.end() - end);
  return fmt::format("{}: {}{}{}.", likelihoodOfOthers(d), fmt::join(others, pairs ? "; or " : " or "),
                     more > 0 ? fmt::format("{}or {}", pairs ? "; " : ", ", counted(more, "other explanation")) : "", experiment);
}

/// A warning if the motion is so sensitive that the step size, or slightly stronger muscles, change it by a noticeable share of the gap.
std::string unsteadyWords(const Unsteady& unsteady) {
  if (!isNoticeable(unsteady)) return "";
  return fmt::format(
      "Under these commands the simulated motion is sensitive: {} {} by {:.0f} times the noise, {:.0f} % of the gap, as happens after "
      "impacts on stops. Such motions hardly distinguish causes; record gentler ones.",
      unsteady.by == Unsteady::Change::steps ? "internal steps twice as long move" : "muscles that pull 0.1 % harder move", unsteady.signal,
      unsteady.in_sigmas, 100 * unsteady.share_of_gap);
}

constexpr double worth_a_warning = 0.1;  ///< an unknown cause that is less likely is not mentioned

/// The probability that something else acts than the candidates, where no cause is believed, if it is worth saying.
std::string noneWords(const Diagnosis& d) {
  const double something_else = std::max(d.none_of_these, d.remainder.probability);
  if (something_else < worth_a_warning) return "";
  std::string words = fmt::format("With a probability of {}, something acts that is ", probabilityWords(something_else));
  if (d.candidates.empty()) return words + "none of the known effects, alone or beside them.";
  if (d.candidates.size() == 1)
    words += fmt::format("not {}, alone or beside it", d.candidates.front());
  else
    words += fmt::format("none of {}, alone or beside them", fmt::join(d.candidates, ", "));
  return words + "; other effects were not considered.";
}

/// The probability that the effects found only stand in for something else, if it is worth saying.
std::string standInWords(const Diagnosis& d) {
  if (d.none_of_these < worth_a_warning) return "";
  return fmt::format("With a probability of {}, {} in for a cause that is {}.", probabilityWords(d.none_of_these),
                     d.chosen.size() > 1 ? "these effects only stand" : "this effect only stands",
                     d.candidates.empty() ? "none of the known effects"
                                          : fmt::format("not among {}; other effects were not considered", fmt::join(d.candidates, ", ")));
}

std::string mostProbable(const Diagnosis& d) {
  const FoundEffect& first = d.effects.front();
  return fmt::format(": the best candidate, {}, has a probability of {}", labelWords(first.label()), probabilityWords(first.probability));
}

/// The most probable effect explains the fitted recordings but not the held-out data.
std::string notConfirmed(const Diagnosis& d) {
  const FoundEffect& first = d.effects.front();
  std::string text = fmt::format(
      ": the best candidate, {}, has a probability of {} on the recordings that it was fitted to, but removes {} of the gap on the "
      "held-out data",
      labelWords(first.label()), probabilityWords(first.probability),
      first.reduction_percent.value_or(0) > 0 ? percentWords(*first.reduction_percent) : "nothing");
  if (d.nominal_refit_percent > 0)
    text += fmt::format("; re-tuning the model without any effect removes {}", percentWords(d.nominal_refit_percent));
  return text;
}

/// The shape of the signal with the largest gap that has a simple one, for a reader who looks for a cause outside the catalogue.
std::string shape(const Diagnosis& d) {
  std::string words;
  double most = 0;
  for (const auto& [signal, gap] : d.before.per_signal)
    if (const std::string shape = shapeOfRest(d, signal); !shape.empty() && overNoise(gap) > most) {
      most = overNoise(gap);
      words = fmt::format("In {} the residual is {}.", signal, shape);
    }
  return words;
}

std::vector<std::string> unexplainedSentences(const Diagnosis& d) {
  if (d.partial) return {"There is a gap; the search for its cause was interrupted."};
  if (d.held_out_is_noise) {
    std::vector<std::string> sentences = {
        "I cannot tell: the fitted recordings show a gap, but the held-out data does not, so no cause can be confirmed; put a recording "
        "that shows the gap last."};
    if (!d.effects.empty()) sentences.push_back("On the fitted recordings" + mostProbable(d).substr(1) + ".");
    return sentences;
  }
  std::string text = "There is a gap that I cannot explain";
  if (!d.effects.empty()) text += d.effects.front().probability > likely ? notConfirmed(d) : mostProbable(d);
  std::vector<std::string> sentences = {text + ".", noneWords(d), d.where.empty() ? "" : whereSentence(d) + ".", shape(d),
                                        fittedNumbersSentence(d)};
  if (d.attempt.effects.empty()) return sentences;
  sentences.push_back(
      fmt::format("The best rejected hypothesis, {}, removes {} of the gap on held-out data; attempt.json holds it as a starting point, "
                  "not as a finding.",
                  listWords(d.attempt.effects), percentWords(d.attempt.reduction_percent)));
  sentences.push_back(retunedSentence(d));
  sentences.push_back(remainder(d, d.attempt.after));
  return sentences;
}

std::vector<std::string> foundSentences(const Diagnosis& d) {
  const auto best = std::ranges::find(d.explanations, d.chosen, &ExplanationProbability::effects);
  return {d.where.empty() ? "" : whereSentence(d) + ".",
          fmt::format("The best explanation ({} likely) is {}; adding {} to the model removes {}{} of the gap on held-out data.",
                      probabilityWords(best == d.explanations.end() ? 0 : best->probability), chosenWords(d),
                      d.chosen.size() > 1 ? "them" : "it", percentWords(d.reduction_percent), intervalWords(d)),
          remainder(d, d.after),
          numbersWords(d),
          numbersInsteadWords(d),
          standInWords(d),
          otherwise(d)};
}

}  // namespace

std::string smallGapSentence(const Diagnosis& d) {
  if (!d.small_gap) return "";
  return fmt::format(
      "The model is off by {:.2g} % of the motion at most, in {}: more than the noise, but less than what is looked into "
      "(--smallest-gap-percent).",
      d.small_gap->percent_of_motion, d.small_gap->signal);
}

std::vector<std::string> answerSentences(const Diagnosis& d) {
  std::vector<std::string> sentences;
  switch (d.verdict) {
    case Verdict::no_gap:
      if (d.numbers.empty() && !d.small_gap) return {"No gap: the recordings agree with the model up to the noise."};
      sentences = {d.numbers.empty()
                       ? "No gap that matters."
                       : "No gap that needs an effect: within the tolerances of its numbers the model agrees with the recordings.",
                   fittedNumbersSentence(d), numbersWords(d), smallGapSentence(d)};
      break;
    case Verdict::not_excited:
      return {"I cannot tell: the commands do not change, so the recordings do not show how the plant responds."};
    case Verdict::unexplained:
      sentences = unexplainedSentences(d);
      break;
    case Verdict::effects_found:
      sentences = foundSentences(d);
  }
  sentences.push_back(unsteadyWords(d.unsteady));
  return sentences;
}

namespace {

/// A recording of a simulated machine with effects is compared with a model that has them too, which surprises who looks for them.
std::string modelEffectsWords(const Diagnosis& d) {
  if (d.model_effects.empty()) return "";
  return fmt::format("The model has {} from the recordings' active_effects already; to look for {}, diagnose --without-active-effects.",
                     listWords(d.model_effects), d.model_effects.size() == 1 ? "it" : "them");
}

}  // namespace

Caveats caveatsOf(const Diagnosis& d) {
  return {d.verdict == Verdict::effects_found ? remainder(d, d.after) : "",
          numbersWords(d),
          numbersInsteadWords(d),
          d.verdict == Verdict::effects_found ? standInWords(d) : noneWords(d),
          otherwise(d),
          unsteadyWords(d.unsteady),
          modelEffectsWords(d)};
}

std::string verdictSentence(const Diagnosis& d) {
  std::vector<std::string> sentences = answerSentences(d);
  sentences.insert(sentences.begin(), modelEffectsWords(d));
  std::erase(sentences, "");
  return fmt::format("{}", fmt::join(sentences, " "));
}

}  // namespace musclesim
