#include "report_shared.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "../../log/svg.h"
#include "../words/effect_words.h"
#include "../words/sentences.h"
#include "musclesim/effect/catalogue.h"

namespace musclesim::report {

namespace {

/// A rejected explanation's effect, whose parameters have no intervals.
FoundEffect withoutIntervals(const ActiveEffect& effect) {
  FoundEffect found{effect.id, effect.component, 0, {}};
  for (const auto& [name, value] : effect.parameters)
    if (const auto* number = std::get_if<double>(&value))
      found.parameters[name] = {*number, *number, *number};
    else if (const auto* word = std::get_if<std::string>(&value))
      found.choices[name] = *word;
  return found;
}

}  // namespace

std::string heading(const std::string& words) {
  return "<h2>" + words + "</h2>\n";
}

std::string breakable(const std::string& label) {
  std::string text;
  for (const char c : escapedXml(label)) text += c == '_' || c == '@' || c == '.' ? std::string(1, c) + "<wbr>" : std::string(1, c);
  return text;
}

std::string breakableCode(const std::string& label) {
  return "<code>" + breakable(label) + "</code>";
}

std::string paragraph(const std::string& words) {
  return words.empty() ? "" : "<p>" + escapedXml(words) + "</p>\n";
}

std::string command(const std::string& words) {
  std::string text = escapedXml(words);
  const std::string option = " --", split = "</span> <span class=word>--";
  for (std::size_t at = text.find(option); at != std::string::npos; at = text.find(option, at + split.size()))
    text.replace(at, option.size(), split);
  return "<code><span class=word>" + text + "</span></code>";
}

std::string lead(const std::string& markup) {
  return "<p class=lead>" + markup + "</p>\n";
}

std::string small(const std::string& words) {
  return "<p class=small>" + escapedXml(words) + "</p>\n";
}

bool hasAfter(const Diagnosis& d) {
  return !d.chosen.empty() || !d.attempt.effects.empty();
}

const Gap& gapAfter(const Diagnosis& d) {
  return d.attempt.effects.empty() ? d.after : d.attempt.after;
}

double percentLeft(const Diagnosis& d) {
  return d.attempt.effects.empty() ? d.unexplained_percent : 100 - d.attempt.reduction_percent;
}

std::vector<std::string> comparedSignals(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const auto& [name, gap] : d.before.per_signal) names.push_back(name);
  return names;
}

std::vector<FoundEffect> shownEffects(const Diagnosis& d) {
  std::vector<FoundEffect> shown;
  const std::vector<ActiveEffect>& offered = d.chosen.empty() ? d.attempt.active_effects : d.chosen_effects;
  const std::vector<std::string>& labels = d.chosen.empty() ? d.attempt.effects : d.chosen;
  for (const std::string& label : labels) {
    const auto listed = std::ranges::find(d.effects, label, &FoundEffect::label);
    const auto given = std::ranges::find_if(offered, [&](const ActiveEffect& e) { return e.id + "@" + e.component == label; });
    if (listed != d.effects.end() && !d.chosen.empty())
      shown.push_back(*listed);
    else if (given != offered.end())
      shown.push_back(withoutIntervals(*given));
    if (listed != d.effects.end() && !shown.empty()) shown.back().probability = listed->probability;
  }
  const std::vector<EffectInfo> catalogue = effectCatalogue();
  std::ranges::stable_sort(
      shown, {}, [&](const FoundEffect& effect) { return std::ranges::find(catalogue, effect.id, &EffectInfo::id) - catalogue.begin(); });
  return shown;
}
double overNoiseInAll(const Gap& gap) {
  return std::sqrt(1 + gap.normalised);
}

std::vector<std::string> sharedEffects(const Diagnosis& d) {
  if (d.ambiguity_sets.empty()) return {};
  std::vector<std::string> shared = d.ambiguity_sets.front();
  for (const std::vector<std::string>& set : d.ambiguity_sets)
    std::erase_if(shared, [&](const std::string& label) { return std::ranges::find(set, label) == set.end(); });
  return shared;
}

bool isAmbiguous(const Diagnosis& d) {
  return d.alternatives.size() > 1 && sharedEffects(d).size() < d.chosen.size();
}

bool isRestLeft(const Diagnosis& d) {
  return overNoiseInAll(d.after) >= stands_out_of_noise && !d.remainder.is_within_steps;
}

Belief beliefOf(const Diagnosis& d) {
  if (d.partial) return Belief::cannot_tell;
  if (d.verdict == Verdict::no_gap) return Belief::no_gap;
  if (d.verdict != Verdict::effects_found) return Belief::cannot_tell;
  return isRestLeft(d) || isAmbiguous(d) || !d.numbers_instead.empty() || !std::ranges::all_of(shownEffects(d), holdsOnUnseenData) ||
                 isNoticeable(d.unsteady) || std::max(d.none_of_these, d.remainder.probability) >= rather_none
             ? Belief::partly
             : Belief::explained;
}

std::string effectTitles(const std::vector<std::string>& labels) {
  std::vector<std::string> titles;
  for (const std::string& label : labels) titles.push_back(effectTitleOn(label));
  return fmt::format("{}", fmt::join(titles, " with "));
}

std::string fileOptions(const Diagnosis& d) {
  return std::string(fittedNumbersToml(d).empty() ? "" : "--config nominal.toml ") + "--effects " +
         (d.chosen.empty() ? "attempt.json" : "effects.json") + substepsOption(d);
}

std::string substepsOption(const Diagnosis& d) {
  return d.substeps > 0 ? fmt::format(" --substeps {}", d.substeps) : "";
}

}  // namespace musclesim::report
