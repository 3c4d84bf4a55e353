// report.html: one page, self-contained.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <variant>

#include "../log/svg.h"
#include "effect_sketch.h"
#include "effect_words.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/version.h"
#include "noise_sigma.h"
#include "report_figures.h"
#include "report_page.h"
#include "sentences.h"

namespace musclesim {

namespace {

std::string heading(const std::string& words) {
  return "<h2>" + words + "</h2>\n";
}

/// A label with a possible line break after each of its words.
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

/// A command that is split over lines only before an option.
std::string command(const std::string& words) {
  std::string text = escapedXml(words);
  const std::string option = " --", split = "</span> <span class=word>--";
  for (std::size_t at = text.find(option); at != std::string::npos; at = text.find(option, at + split.size()))
    text.replace(at, option.size(), split);
  return "<code><span class=word>" + text + "</span></code>";
}

/// A paragraph that introduces the following figure or table, with markup.
std::string lead(const std::string& markup) {
  return "<p class=lead>" + markup + "</p>\n";
}

std::string small(const std::string& words) {
  return "<p class=small>" + escapedXml(words) + "</p>\n";
}

/// Whether there is a model with effects to compare with the one without.
bool hasAfter(const Diagnosis& d) {
  return !d.chosen.empty() || !d.attempt.effects.empty();
}

/// The gap with the effects found, or else with the best rejected explanation.
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

/// The effects of the explanation that the page shows, found or rejected, on the way from command to sensor.
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

constexpr double stands_out_of_noise = 2;  ///< RMS over the noise floor
constexpr double rather_none = 0.5;        ///< probability of "none of these" above which an explanation is believed in part only

/// RMS residual over the noise floor, over all signals.
double overNoiseInAll(const Gap& gap) {
  return std::sqrt(1 + gap.normalised);
}

/// The effects that all explanations share which are as good as the best one.
std::vector<std::string> sharedEffects(const Diagnosis& d) {
  if (d.ambiguity_sets.empty()) return {};
  std::vector<std::string> shared = d.ambiguity_sets.front();
  for (const std::vector<std::string>& set : d.ambiguity_sets)
    std::erase_if(shared, [&](const std::string& label) { return std::ranges::find(set, label) == set.end(); });
  return shared;
}

/// Whether an explanation without one of the causes found would do as well.
bool isAmbiguous(const Diagnosis& d) {
  return d.alternatives.size() > 1 && sharedEffects(d).size() < d.chosen.size();
}

Belief beliefOf(const Diagnosis& d) {
  if (d.partial) return Belief::cannot_tell;
  if (d.verdict == Verdict::no_gap) return Belief::no_gap;
  if (d.verdict != Verdict::effects_found) return Belief::cannot_tell;
  const bool is_rest = overNoiseInAll(d.after) >= stands_out_of_noise;
  return is_rest || isAmbiguous(d) || d.none_of_these > rather_none ? Belief::partly : Belief::explained;
}

struct SignWords {
  const char *look, *word;
  std::string sentence;
};

SignWords signWords(const Diagnosis& d, Belief belief) {
  switch (belief) {
    case Belief::explained:
      return {"explained", "Explained", "You can believe place, kind and numbers of the cause below."};
    case Belief::partly:
      return {"partly", "Explained in part",
              isAmbiguous(d) ? "Other causes would explain these recordings as well: record more before you rely on this one."
                             : "Believe the place and the kind of the cause; its numbers are rough, and something else is left."};
    case Belief::cannot_tell:
      return {"cannot_tell", "Cannot tell", "Believe none of the causes yet."};
    case Belief::no_gap:
      return {"no_gap", "No gap", "You can believe the model for motions like these."};
  }
  return {};
}

/// "other load (the hand) with leak (muscle 0)".
std::string effectTitles(const std::vector<std::string>& labels) {
  std::vector<std::string> titles;
  for (const std::string& label : labels) titles.push_back(effectTitleOn(label));
  return fmt::format("{}", fmt::join(titles, " with "));
}

/// The answer where no cause is believed.
std::string headlineWithoutCause(const Diagnosis& d) {
  const bool is_small = std::ranges::all_of(d.before.per_signal, [](const auto& entry) { return overNoise(entry.second) < out_of_noise; });
  if (d.verdict != Verdict::unexplained || d.partial || is_small) {
    const std::vector<std::string> answer = answerSentences(d);
    return answer.empty() ? "" : answer.front();
  }
  const std::string gap = "There is a gap that I cannot explain.";
  if (d.effects.empty()) return gap + " No known cause comes close.";
  return gap + fmt::format(" The likeliest cause, {}, has a probability of only {}.", effectTitleOn(d.effects.front().label()),
                           probabilityWords(d.effects.front().probability));
}

std::string headline(const Diagnosis& d) {
  if (d.verdict != Verdict::effects_found) return "<div class=headline>" + paragraph(headlineWithoutCause(d)) + "</div>\n";
  const std::vector<FoundEffect> effects = shownEffects(d);
  const std::vector<std::string> claims = claimSentences(effects, comparedSignals(d));
  std::string text;
  if (claims.size() == 1) text = paragraph(claims.front());
  for (std::size_t i = 0; claims.size() > 1 && i < claims.size(); ++i) text += "<li>" + escapedXml(claims[i]) + "</li>";
  if (claims.size() > 1) text = "<ul>" + text + "</ul>";
  return "<div class=headline>" + text +
         fmt::format("<p>{} {} of the {} on {}.</p></div>\n", effects.size() > 1 ? "Together they explain" : "This explains",
                     percentWords(d.reduction_percent), term("gap"), term("held_out"));
}

/// Where the causes found act, then what the signals say without any cause in mind.
std::string whereAnswer(const Diagnosis& d) {
  if (d.verdict == Verdict::no_gap || d.verdict == Verdict::not_excited) return "<p>Nowhere: no signal stands out of its noise.</p>";
  const std::string seen = d.where.empty() ? "" : whereSentence(d) + ".";
  if (d.chosen.empty()) return seen.empty() ? "<p>Not known.</p>" : paragraph(seen);
  std::vector<std::string> places;
  std::string unconfirmed;
  for (const FoundEffect& effect : shownEffects(d)) {
    const std::string stage = nameOf(effectInfo(effect.id).stage);
    const std::string place = fmt::format("in the {} stage ({})", stage, ownerWords(effect.id, effect.component));
    if (isLocated(d.where) && !mayBeAt(d.where, stage)) unconfirmed = " The signals alone do not confirm the " + stage + " stage.";
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  }
  return paragraph(
             fmt::format("{} {}.{}", d.chosen.size() > 1 ? "The causes act" : "The cause acts", fmt::join(places, " and "), unconfirmed)) +
         (seen.empty() ? "" : "<p class=small>From the signals alone: " + escapedXml(seen) + "</p>");
}

/// The signal that stands out most.
std::string largestResidual(const Diagnosis& d) {
  const auto most = std::ranges::max_element(d.before.per_signal, {}, [](const auto& entry) { return overNoise(entry.second); });
  if (most == d.before.per_signal.end()) return "";
  return fmt::format(" The largest residual is {:.3g} times its noise floor ({}).", overNoise(most->second), signalTitle(most->first));
}

/// The explanations that are as good as the best one.
std::string alternativesSentence(const Diagnosis& d, const Caveats& caveats) {
  constexpr std::size_t told = 3;
  if (d.effects.empty() || d.none_of_these > rather_none) return "";
  if (d.ambiguity_sets.size() < 2) return caveats.others;
  if (const std::vector<std::string> shared = sharedEffects(d); !shared.empty())
    return fmt::format("{} explanations fit these recordings equally well. All hold {}; they differ in what else acts.",
                       d.ambiguity_sets.size(), effectTitles(shared));
  std::vector<std::string> others;
  const bool is_chosen_first = !d.chosen.empty();
  for (std::size_t i = is_chosen_first ? 1 : 0; i < d.ambiguity_sets.size() && others.size() < told; ++i)
    others.push_back(effectTitles(d.ambiguity_sets[i]));
  const std::size_t more = d.ambiguity_sets.size() - others.size() - (is_chosen_first ? 1 : 0);
  return capitalised(fmt::format("{}{} would explain these recordings {}.", fmt::join(others, ", or "),
                                 more ? fmt::format(", or {} more", more) : "", is_chosen_first ? "as well" : "equally well"));
}

std::string sureAnswer(const Diagnosis& d, const Caveats& caveats) {
  constexpr double worth_telling = 0.05;  // difference of two probabilities
  std::string text;
  if (d.verdict == Verdict::effects_found) {
    const auto best = std::ranges::find(d.explanations, d.chosen, &ExplanationProbability::effects);
    const double together = best == d.explanations.end() ? 0 : best->probability;
    const auto only = std::ranges::find(d.effects, d.chosen.front(), &FoundEffect::label);
    if (d.chosen.size() == 1 && only != d.effects.end())
      text += fmt::format("<p>This cause has a {} of {}{}.</p>", term("probability"), probabilityWords(only->probability),
                          together < only->probability - worth_telling ? "; that nothing else acts, " + probabilityWords(together) : "");
    else if (together > 0)
      text += fmt::format("<p>This explanation has a {} of {} as a whole; each cause has its own below.</p>", term("probability"),
                          probabilityWords(together));
  }
  text += paragraph(alternativesSentence(d, caveats));
  if (d.verdict == Verdict::no_gap || d.verdict == Verdict::not_excited)
    text +=
        fmt::format("<p>A residual is called noise up to {} times its {}, {} times where the floor was estimated from quiet rows.{}</p>",
                    out_of_noise, term("floor"), out_of_estimated_noise, largestResidual(d));
  text += paragraph(caveats.none) + paragraph(caveats.numbers) + paragraph(caveats.unsteady) + paragraph(caveats.model);
  if (d.verdict == Verdict::unexplained && text.empty()) return "<p>No explanation is believed.</p>";
  return text;
}

std::string restAnswer(const Diagnosis& d, const Caveats& caveats) {
  if (d.verdict == Verdict::no_gap) return "<p>Nothing beyond the noise.</p>";
  if (d.verdict == Verdict::not_excited) return "<p>Nothing beyond the noise, but the recordings hardly move the machine.</p>";
  if (d.verdict == Verdict::effects_found) {
    const std::string noise =
        fmt::format("The {} is {:.1f} times the {}: noise, or nearly so.", term("residual"), overNoiseInAll(d.after), term("floor"));
    return fmt::format("<p>{} of the gap. {}</p>", capitalised(leftWords(d.unexplained_percent)),
                       caveats.rest.empty() ? noise : escapedXml(caveats.rest)) +
           paragraph(elsewhereSentence({d.reduction_percent, d.reduction_low_percent, d.reduction_high_percent}));
  }
  std::string text = fmt::format("<p>All of it, since no cause is believed: the {} is {:.3g} times the {}.{}</p>", term("residual"),
                                 overNoiseInAll(d.before), term("floor"), escapedXml(largestResidual(d)));
  if (d.attempt.effects.empty()) return text;
  return text + fmt::format("<p>The best {}, {}, would leave {}.</p>", term("attempt"), escapedXml(effectTitles(d.attempt.effects)),
                            leftWords(percentLeft(d)));
}

std::string fileOptions(const Diagnosis& d) {
  return std::string(d.tuned.empty() ? "" : "--config nominal.toml ") + "--effects " + (d.chosen.empty() ? "attempt.json" : "effects.json");
}

std::string foundSteps(const Diagnosis& d, Belief belief) {
  std::string steps = fmt::format("<li>Add {} to the model: {}.</li>", d.chosen.size() > 1 ? "these causes" : "this cause",
                                  command("musclesim replay NEW.csv " + fileOptions(d)));
  if (!d.next_experiment.commands.empty())
    steps +=
        "<li>Play and record <code>next.csv</code>, then diagnose again with that recording first: it tells the alternatives apart.</li>";
  if (belief == Belief::partly && overNoiseInAll(d.after) >= stands_out_of_noise) {
    steps += fmt::format("<li>Look at the residual of the {} in the curves below for what is left.</li>",
                         d.remainder.signal.empty() ? "signals" : signalTitle(d.remainder.signal));
    if (d.chosen.size() >= 4) steps += "<li>Let the program look for more causes: <code>--max-effects 6</code>.</li>";
  }
  return steps + "<li>Or repair the machine. In both cases, test with a new recording.</li>";
}

std::string nextSteps(const Diagnosis& d, Belief belief) {
  std::string steps;
  if (d.partial)
    steps = "<li>Run the diagnosis again and let it finish.</li>";
  else if (d.verdict == Verdict::no_gap)
    steps =
        "<li>Use the model as it is.</li>" +
        std::string(d.not_excited.empty() ? ""
                                          : "<li>Before you rely on other motions, see the effects that these could not show, below.</li>");
  else if (d.verdict == Verdict::not_excited)
    steps = "<li>Record larger motions, in which every command rises, falls and rests.</li>";
  else if (d.verdict == Verdict::effects_found)
    steps = foundSteps(d, belief);
  else {
    steps =
        "<li>Look at the curves below: which signal is off first, and when?</li>"
        "<li>If numbers of the model were never measured, name them: <code>--tune NAME,...</code>. For more causes at once: "
        "<code>--max-effects 6</code>.</li>";
    if (!d.next_experiment.commands.empty())
      steps += "<li>Play and record <code>next.csv</code>, then diagnose again with that recording first.</li>";
    if (!d.attempt.effects.empty())
      steps += "<li>To build on the rejected explanation: " + command("musclesim diagnose ... --effects attempt.json") + ".</li>";
  }
  return "<ol>" + steps + "</ol>";
}

std::string verdictBox(const Diagnosis& d) {
  const Belief belief = beliefOf(d);
  const SignWords sign = signWords(d, belief);
  const Caveats caveats = caveatsOf(d);
  const auto row = [](const std::string& head, const std::string& text) { return "<dt>" + head + "</dt><dd>" + text + "</dd>\n"; };
  return fmt::format(
      "<section class=\"verdict {}\"><div class=signal>{}<div><strong>{}</strong>{}</div></div>\n{}<dl "
      "class=answers>\n{}{}{}{}</dl></section>\n",
      sign.look, signFigure(belief), sign.word, sign.sentence, headline(d), row("Where", whereAnswer(d)),
      row("How sure", sureAnswer(d, caveats)), row("How much is left", restAnswer(d, caveats)),
      row("What to do next", nextSteps(d, belief)));
}

/// The robot with the located component in colour, or else the component of the best explanation.
std::string drawing(const Diagnosis& d) {
  if (d.drawing.lines.empty()) return "";
  Place place;
  std::string words = "The robot from the front.";
  const auto best =
      std::ranges::find_if(d.effects, [&](const FoundEffect& effect) { return !d.chosen.empty() && effect.label() == d.chosen.front(); });
  if (isLocated(d.where)) {
    place = d.where.front();
    words += fmt::format(" In colour, if it can be drawn: {}, where the gap arises.", componentWords(place.component));
  } else if (best != d.effects.end()) {
    place = {nameOf(effectInfo(best->id).stage), best->component, {}};
    words += fmt::format(
        " In colour, if it can be drawn: {}, where the best explanation acts; this follows from the search for causes below, not from the "
        "boxes.",
        componentWords(place.component));
  }
  return "<div class=robot>" + robotFigure(d.drawing, place) + small(words) + "</div>\n";
}

std::string where(const Diagnosis& d) {
  if (d.where.empty()) return "";
  return heading("Where") + "<div class=place><div>" +
         lead("A sample passes five " + term("stage", "stages") + ". The darker a box, the likelier the gap arises there" +
              (isLocated(d.where) ? "; a thick red frame marks where the signals leave no other choice:" : ":")) +
         "<figure>" + stagesFigure(d.where) + "</figure>" + paragraph("Evidence: " + d.where_method + ".") + "</div>" + drawing(d) +
         "</div>\n";
}

std::string parameterTable(const FoundEffect& effect, const Diagnosis& d) {
  std::string rows;
  for (const ParameterLine& line : parameterLines(effect, comparedSignals(d))) {
    std::string notes = line.interval;
    if (!line.remark.empty()) notes += (notes.empty() ? "" : "; ") + line.remark;
    rows += fmt::format("<tr><td>{}</td><td class=number><b>{}</b></td><td class=small>{}</td></tr>", escapedXml(line.label),
                        escapedXml(line.value), escapedXml(notes));
  }
  return rows.empty() ? "" : "<table><tbody>" + rows + "</tbody></table>";
}

/// The catalogue's entry, which opens in place.
std::string referenceOf(const std::string& id) {
  const EffectInfo info = effectInfo(id);
  return fmt::format(
      "<details class=more><summary>Reference</summary><p><code>{}</code>: {}.</p><p><code>{}</code></p><p>How it differs from others: "
      "{}.</p>"
      "<p>Source: {}.</p><p class=small><code>musclesim effects {}</code> prints this; docs/reference/effects.md has "
      "figures.</p></details>",
      escapedXml(id), escapedXml(info.summary), escapedXml(info.equation), escapedXml(info.signature), escapedXml(info.source),
      escapedXml(id));
}

std::string effectCard(const FoundEffect& effect, const Diagnosis& d) {
  std::string facts;
  if (effect.probability > 0) facts = fmt::format("Probability {}. ", probabilityWords(effect.probability));
  if (effect.reduction_percent) facts += fmt::format("Removes {} of the gap alone", percentWords(*effect.reduction_percent));
  if (effect.removes_percent && d.chosen.size() > 1)
    facts +=
        fmt::format("{} {} {}", effect.reduction_percent ? ", and" : "Removes", percentWords(*effect.removes_percent), "beside the others");
  if (effect.reduction_percent || (effect.removes_percent && d.chosen.size() > 1)) facts += ".";
  return fmt::format(
      "<article class=card data-effect=\"{0}\"><div><div><h3>{1}</h3><p "
      "class=small><code>{0}</code></p><p>{2}</p>{3}<p>{4}</p>{5}</div>{6}</div></article>\n",
      escapedXml(effect.label()), escapedXml(capitalised(effectTitleOn(effect.label()))), escapedXml(effectExplanation(effect.id)),
      parameterTable(effect, d), facts, referenceOf(effect.id), effectSketch(effect.id));
}

/// The causes that were considered beside those of the cards.
std::string otherCauses(const Diagnosis& d, const std::vector<FoundEffect>& shown) {
  std::string rows;
  for (const FoundEffect& effect : d.effects) {
    if (std::ranges::find(shown, effect.label(), &FoundEffect::label) != shown.end()) continue;
    std::vector<std::string> values;
    for (const ParameterLine& line : parameterLines(effect, comparedSignals(d))) values.push_back(line.label + ": " + line.value);
    rows += fmt::format(
        "<tr><td data-head=cause><span>{}<br>{}</span></td><td class=number data-head=probability>{}</td><td data-head=\"fitted "
        "values\">{}</td>"
        "<td class=number data-head=\"removes alone\">{}</td></tr>\n",
        escapedXml(effectTitleOn(effect.label())), breakableCode(effect.label()), probabilityWords(effect.probability),
        escapedXml(fmt::format("{}", fmt::join(values, "; "))),
        effect.reduction_percent ? percentWords(*effect.reduction_percent) : "not tried");
  }
  rows += fmt::format("<tr><td data-head=cause>none of these</td><td class=number data-head=probability>{}</td><td></td><td></td></tr>\n",
                      probabilityWords(d.none_of_these));
  return lead(shown.empty() ? "Causes that were considered:" : "Also considered:") +
         "<table class=wide><thead><tr><th>cause</th><th class=number>probability</th><th>fitted values</th><th class=number>removes "
         "alone</th></tr></thead><tbody>" +
         rows + "</tbody></table>\n";
}

/// The probabilities of sets of effects, if any set has several.
std::string togetherList(const Diagnosis& d) {
  if (std::ranges::none_of(d.explanations, [](const auto& fitted) { return fitted.effects.size() > 1; })) return "";
  std::string items;
  for (const ExplanationProbability& fitted : d.explanations) {
    if (fitted.effects.empty()) continue;
    items += fmt::format("<li>{}: {}</li>", probabilityWords(fitted.probability), escapedXml(effectTitles(fitted.effects)));
  }
  return "<details class=more><summary>Probabilities of whole explanations</summary><ul>" + items + "</ul></details>\n";
}

std::string which(const Diagnosis& d) {
  if (d.verdict == Verdict::no_gap || d.verdict == Verdict::not_excited || (d.effects.empty() && d.none_of_these == 0)) return "";
  const std::vector<FoundEffect> shown = shownEffects(d);
  std::string text = heading(d.chosen.empty() ? "Which cause" : d.chosen.size() > 1 ? "Which causes" : "Which cause");
  if (d.chosen.empty() && !shown.empty())
    text += lead("No explanation is believed. The best " + term("attempt") +
                 (shown.size() > 1 ? " has these causes together:" : " is this cause:"));
  if (!d.chosen.empty())
    text +=
        lead("Numbers come with a " + term("interval") + " where the recordings tell one; " + term("muscle", "muscles are counted from 0") +
             "." + (shown.size() > 1 ? " What a cause removes is given " + term("alone") + "." : ""));
  for (const FoundEffect& effect : shown) text += effectCard(effect, d);
  text += otherCauses(d, shown) + togetherList(d);
  if (!d.effects.empty() && !d.alternatives.empty()) {
    text += "<p>These recordings cannot distinguish:</p><ul>";
    for (const std::vector<std::string>& set : d.ambiguity_sets) text += "<li>" + escapedXml(effectTitles(set)) + "</li>";
    text += "</ul>\n";
  }
  return text;
}

/// What each effect removes as one is added after the other.
std::string removalFigure(const Diagnosis& d) {
  if (d.removal.size() < 2) return "";
  std::vector<Bar> all = {{"gap before", 100, "100 %", "plain"}};
  double left = 100, full = 100;
  for (const RemovalStep& step : d.removal) {
    const double removed = left - step.left_percent;
    all.push_back({"with " + effectTitleOn(step.effect), std::abs(removed),
                   fmt::format("{} {:.3g} %", removed < 0 ? "+" : "\u2212", std::abs(removed)), removed < 0 ? "added" : "removed",
                   std::min(left, step.left_percent)});
    full = std::max(full, step.left_percent);
    left = step.left_percent;
  }
  all.push_back({"left", left, leftWords(left), "strong"});
  return lead("What each cause removes (hatched) when they are added one after the other, the one that removes most first:") +
         barsFigure("What each cause removes", all, full);
}

/// Bars of the remaining gap: with the effects and with both controls.
std::string controlsFigure(const Diagnosis& d) {
  std::vector<Bar> all = {
      {"gap before", 100, "100 %"},
      {"model re-tuned, no effect (control)", 100 - d.nominal_refit_percent, leftWords(100 - d.nominal_refit_percent)},
      {"disturbance without meaning (control)", 100 - d.negative_control_percent, leftWords(100 - d.negative_control_percent)},
      {d.chosen.empty() ? "best rejected explanation" : "with the effects found", percentLeft(d), leftWords(percentLeft(d)), "strong"}};
  return lead("What is left, beside two controls that an explanation should beat clearly: the " + term("refit") + " and a " + term("sham") +
              ":") +
         barsFigure("Remaining gap", all, std::max({100.0, all[1].value, all[2].value, all[3].value})) +
         small(fmt::format("Re-tuned were: {}.", fmt::join(d.refitted, ", ")));
}

std::string phaseFigure(const Diagnosis& d) {
  std::vector<Bar> all;
  double full = 1;
  for (const PhaseGap& phase : d.phases) {
    full = std::max({full, phase.before, phase.after});
    all.push_back({"while " + phase.phase + (hasAfter(d) ? ", before" : ""), phase.before, fmt::format("{:.3g}", phase.before)});
    if (hasAfter(d) && phase.after > 0) all.push_back({"after", phase.after, fmt::format("{:.3g}", phase.after), "strong"});
  }
  if (all.empty()) return "";
  return lead("Residual in " + term("floor", "noise floors") + " (1 is noise alone) during " + term("phase") + ":") +
         barsFigure("Residual by phase", all, full);
}

std::string signalTable(const Diagnosis& d) {
  const auto times = [](const SignalGap& gap) { return fmt::format("{:.3g} ({:.3g}\u00d7)", gap.rmse, overNoise(gap)); };
  const auto cell = [](const char* head, const std::string& text) {
    return fmt::format("<td class=number data-head=\"{}\">{}</td>", head, text);
  };
  std::string rows;
  for (const auto& [name, before] : d.before.per_signal) {
    const auto found = gapAfter(d).per_signal.find(name);
    const SignalGap& after = hasAfter(d) && found != gapAfter(d).per_signal.end() ? found->second : before;
    rows += "<tr><td data-head=signal><span>" + escapedXml(signalTitle(name)) + "<br>" + breakableCode(name) + "</span></td>" +
            cell("noise floor", fmt::format("{:.3g} {}", before.noise_sigma, escapedXml(signalUnitWords(name)))) +
            cell(hasAfter(d) ? "residual before" : "residual", times(before)) + (hasAfter(d) ? cell("residual after", times(after)) : "") +
            "<td data-head=shape>" + shapeOfRest(d, name) + "</td></tr>\n";
  }
  return lead("By signal: typical residual (RMS), in the signal's unit and as a multiple of its noise floor.") +
         "<table class=wide><thead><tr><th>signal</th><th class=number>noise floor</th>" +
         (hasAfter(d) ? "<th class=number>residual before</th><th class=number>residual after</th>" : "<th class=number>residual</th>") +
         "<th>shape</th></tr></thead><tbody>" + rows + "</tbody></table>\n";
}

std::string howFar(const Diagnosis& d) {
  const bool searched = d.verdict == Verdict::effects_found || d.verdict == Verdict::unexplained;
  std::string text = heading(hasAfter(d) ? "How far" : "How close the model comes");
  text += lead(escapedXml(searched ? "Measured on " + d.held_out + "."
                                   : fmt::format("All {} recordings were compared; the figures below are of {}.", d.recordings.size(),
                                                 std::filesystem::path(d.recordings.back()).filename().string())));
  if (hasAfter(d) && d.chosen.empty()) text += paragraph("No explanation was accepted: below, \"after\" means with the best rejected one.");
  if (hasAfter(d)) text += removalFigure(d) + controlsFigure(d);
  text += phaseFigure(d) + signalTable(d);
  if (!searched)
    text +=
        paragraph("A smaller difference than these is not seen, nor is an effect that these commands do not excite: no effect was fitted.");
  return text;
}

/// Traces by RMS over sigma, largest first.
std::vector<const Trace*> tracesByGap(const Diagnosis& d) {
  std::vector<const Trace*> traces;
  for (const Trace& trace : d.traces) traces.push_back(&trace);
  std::ranges::stable_sort(traces, std::greater{}, [&](const Trace* trace) {
    const auto gap = d.before.per_signal.find(trace->signal);
    return gap == d.before.per_signal.end() ? 0 : overNoise(gap->second);
  });
  return traces;
}

std::string traceRemark(const Diagnosis& d, const std::string& signal) {
  const auto before = d.before.per_signal.find(signal), after = gapAfter(d).per_signal.find(signal);
  if (before == d.before.per_signal.end() || before->second.noise_sigma <= 0) return "";
  std::string text = fmt::format("residual {:.3g}", overNoise(before->second));
  if (hasAfter(d) && after != gapAfter(d).per_signal.end()) text += fmt::format(" before, {:.3g} after,", overNoise(after->second));
  text += " times the noise floor";
  const std::string shape = shapeOfRest(d, signal);
  return shape.empty() ? text : text + (hasAfter(d) ? "; the rest is " : "; it is ") + shape;
}

std::string curves(const Diagnosis& d) {
  if (d.traces.empty()) return "";
  constexpr std::size_t traces_in_full = 30;  // more are drawn coarser, so that the page stays small
  std::string text =
      heading("Curves") +
      lead("On top, measured and simulated values. Below, the " + term("residual") + " with a grey band of twice the " + term("floor") +
           (hasAfter(d) ? ", and what is left of it on a scale of its own" : "") + ". The signal with the largest gap comes first.") +
      "<p class=tools>Drag over a plot to zoom all of them. With a plot selected: <kbd>+</kbd> <kbd>\u2212</kbd> zoom, <kbd>\u2190</kbd> "
      "<kbd>\u2192</kbd> move the cursor (with <kbd>Shift</kbd> the view), <kbd>0</kbd> or double click: "
      "<button type=button id=whole>show all</button></p>\n";
  const int pixels_per_column = static_cast<int>(1 + d.traces.size() / traces_in_full);
  for (const Trace* trace : tracesByGap(d)) {
    const auto gap = d.before.per_signal.find(trace->signal);
    const double sigma = gap == d.before.per_signal.end() ? 0 : gap->second.noise_sigma;
    text += traceFigure(*trace, {signalTitle(trace->signal), signalUnitWords(trace->signal), traceRemark(d, trace->signal)}, sigma,
                        pixels_per_column);
  }
  return text;
}

const Trace* traceOf(const Diagnosis& d, const std::string& signal) {
  const auto found = std::ranges::find(d.traces, signal, &Trace::signal);
  return found == d.traces.end() ? nullptr : &*found;
}

/// The values of one signal over those of another, at the rows that both have.
Loop loopOf(const Trace& across, const Trace& up) {
  Loop loop{fmt::format("{} over {}", signalTitle(up.signal), signalTitle(across.signal)),
            fmt::format("{}, {}", signalTitle(across.signal), signalUnitWords(across.signal)),
            fmt::format("{}, {}", signalTitle(up.signal), signalUnitWords(up.signal)),
            {}};
  loop.curves.resize(up.after.empty() || across.after.empty() ? 2 : 3);
  for (std::size_t i = 0, k = 0; i < across.time_s.size() && k < up.time_s.size();) {
    if (across.time_s[i] != up.time_s[k]) {
      across.time_s[i] < up.time_s[k] ? ++i : ++k;
      continue;
    }
    const auto add = [&](std::size_t curve, double x, double y) {
      loop.curves[curve].x.push_back(x);
      loop.curves[curve].y.push_back(y);
    };
    add(0, across.measured[i], up.measured[k]);
    add(1, across.before[i], up.before[k]);
    if (loop.curves.size() > 2) add(2, across.after[i], up.after[k]);
    ++i, ++k;
  }
  return loop;
}

/// Pressure-length loops, or pressure-angle loops, where a cause in the force or body stage makes them tell more than curves over time.
std::string loops(const Diagnosis& d) {
  const auto acts_behind_pressure = [](const FoundEffect& effect) {
    const Stage stage = effectInfo(effect.id).stage;
    return stage == Stage::force || stage == Stage::body;
  };
  const std::vector<FoundEffect> shown = shownEffects(d);
  if (d.verdict == Verdict::effects_found && std::ranges::none_of(shown, acts_behind_pressure)) return "";
  constexpr int most_muscles = 4;
  const auto first_angle = std::ranges::find_if(d.traces, [](const Trace& trace) { return trace.signal.starts_with("angle_"); });
  std::string figures;
  for (int muscle = 0; muscle < most_muscles; ++muscle) {
    const Trace* pressure = traceOf(d, fmt::format("pressure_{}", muscle));
    const Trace* length = traceOf(d, fmt::format("length_{}_mm", muscle));
    if (!length && first_angle != d.traces.end()) length = &*first_angle;
    if (pressure && length) figures += loopFigure(loopOf(*pressure, *length));
  }
  if (figures.empty()) return "";
  return heading("Loops") + lead("The same data without time: friction and hysteresis open a loop, a wrong force law bends or shifts it.") +
         "<div class=loops>" + figures + "</div>\n";
}

/// The tuned parameters of the model that everything is compared with.
std::string tuned(const Diagnosis& d) {
  if (d.tuned.empty()) return "";
  std::string rows;
  const bool together = hasAfter(d);
  for (const TunedParameter& p : d.tuned) {
    rows += fmt::format(
        "<tr><td data-head=parameter>{}</td><td class=number data-head=given>{:.4g} {}</td><td class=number data-head=fitted>{}</td>",
        breakableCode(p.name), p.start, p.unit, estimateWords(p.fitted));
    if (together) rows += fmt::format("<td class=number data-head=\"with the effects\">{}</td>", estimateWords(p.with_effects));
    rows += "</tr>\n";
  }
  return heading("The model") +
         paragraph(
             "Nobody measured these parameters of the model. They were fitted first, without any effect and without the held-out data; "
             "every gap \"before\" on this page is the gap of the model with these values. They were fitted again together with every "
             "effect that was tried, because a parameter and an effect can stand in for each other. nominal.toml holds the last column, "
             "for --config.") +
         "<table class=wide><thead><tr><th>parameter</th><th class=number>given</th><th class=number>fitted (95 % interval)</th>" +
         std::string(together ? "<th class=number>fitted with the effects</th>" : "") + "</tr></thead><tbody>\n" + rows +
         "</tbody></table>";
}

/// Bars of the share of the log misfit that each effect would remove by screening: the strongest effects, and the chosen ones at any rank.
std::string screenings(const Diagnosis& d) {
  constexpr std::size_t shown = 12;
  std::vector<std::pair<Screening, std::size_t>> places;  // the best variant of each label, with its rank
  for (const Screening& screening : d.screenings)
    if (std::ranges::none_of(places, [&](const auto& place) { return place.first.effect == screening.effect; }))
      places.emplace_back(screening, places.size() + 1);
  if (places.empty()) return "";
  std::vector<Bar> all;
  bool some_not_fitted = false;
  for (const auto& place : places) {
    const Screening& screening = place.first;
    const std::size_t rank = place.second;
    const bool chosen = std::ranges::find(d.chosen, screening.effect) != d.chosen.end();
    if (rank > shown && !chosen) continue;
    const bool fitted = std::ranges::any_of(
        d.trials, [&](const Trial& trial) { return std::ranges::find(trial.effects, screening.effect) != trial.effects.end(); });
    some_not_fitted |= !fitted;
    all.push_back({fmt::format("{}. {}", rank, effectTitleOn(screening.effect)), screening.removed,
                   fmt::format("{:.0f} %", 100 * screening.removed), fitted ? "strong" : "plain"});
  }
  const std::string which = places.size() <= shown ? "" : fmt::format("; these are the first {} and the chosen ones", shown);
  return lead(fmt::format("{} screened{}. Each bar is the share of the logarithm of the gap that the effect would remove if its response "
                          "were proportional to its strength; a fit follows the true response and may remove more{}:",
                          counted(places.size(), "effect on a component was", "effects on components were"), which,
                          some_not_fitted ? "; the dark ones were fitted" : "")) +
         barsFigure("Screening", all, 1);
}

/// "leak (every muscle, muscle 0), creep (muscle 0)" from labels in this order.
std::string groupedWords(const std::vector<std::string>& labels) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;
  for (const std::string& label : labels) {
    const std::string id = label.substr(0, label.find('@')), component = ownerWords(id, label.substr(label.find('@') + 1));
    auto group = std::ranges::find(groups, id, &std::pair<std::string, std::vector<std::string>>::first);
    if (group == groups.end()) group = groups.insert(groups.end(), {id, {}});
    if (std::ranges::find(group->second, component) == group->second.end()) group->second.push_back(component);
  }
  std::vector<std::string> words;
  for (const auto& [id, components] : groups) words.push_back(fmt::format("{} ({})", effectTitle(id), fmt::join(components, ", ")));
  return fmt::format("{}", fmt::join(words, ", "));
}

/// {"a@x", "b@y"} of "a@x + b@y".
std::vector<std::string> splitLabels(const std::string& labels) {
  const std::string link = " + ";
  std::vector<std::string> parts;
  for (std::size_t first = 0, end = 0; end != std::string::npos; first = end + link.size()) {
    end = labels.find(link, first);
    parts.push_back(labels.substr(first, end - first));
  }
  return parts;
}

std::string nextExperiment(const Diagnosis& d) {
  if (d.next_experiment.commands.empty()) return "";
  std::vector<std::string> titles;
  for (const std::string& labels : d.next_experiment.separates) titles.push_back(effectTitles(splitLabels(labels)));
  return heading("Next experiment") +
         paragraph(
             fmt::format("{} {} apart, play the {:.0f} s of commands in next.csv, {}. Check first that they are safe for the machine. Then "
                         "run diagnose with "
                         "the new recording as the first file, followed by the recordings of this page.",
                         d.verdict == Verdict::unexplained ? "In case one of the known effects is the cause after all: to tell" : "To tell",
                         fmt::join(titles, " and "), d.next_experiment.time_s.back(), d.next_experiment.why));
}

std::string useIt(const Diagnosis& d) {
  if (!hasAfter(d)) return "";
  const std::string options = fileOptions(d);
  return heading("Use it") + "<p>" + command("musclesim replay NEW.csv " + options) + " and " +
         command("musclesim " + d.model_options + " " + options) + " run the model with " +
         (d.chosen.empty() ? "the best rejected explanation" : "the effects found") +
         (d.model_options.find("--set") == std::string::npos ? "" : "; replay takes the robot's parameters from the recording's sidecar") +
         ".</p>\n";
}

std::string notesList(const Diagnosis& d) {
  if (d.notes.empty()) return "";
  std::string text = "<p>Notes:</p><ul>\n";
  for (const std::string& note : d.notes) text += "<li>" + escapedXml(note) + "</li>\n";
  return text + "</ul>\n";
}

std::string whatElse(const Diagnosis& d) {
  std::string text = nextExperiment(d);
  if (!d.not_excited.empty())
    text += heading("Not excited") + paragraph("These recordings could not have shown the following effects, which may be present: " +
                                               groupedWords(d.not_excited) + ".");
  return text + useIt(d) + heading("How it was computed") +
         paragraph(
             fmt::format("{} simulations of {:.0f} s in all took {:.0f} s on the clock.", d.simulation_count, d.simulated_s, d.wall_s)) +
         screenings(d) + notesList(d);
}

/// "Robot elbow; recordings r1.csv, r2.csv, r3.csv."
std::string subject(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const std::string& file : d.recordings) names.push_back(std::filesystem::path(file).filename().string());
  return fmt::format("Robot {}; recordings {}.", std::filesystem::path(d.robot).filename().string(), fmt::join(names, ", "));
}

std::string foot(const Diagnosis& d, const ReportOrigin& origin) {
  std::string text = "<footer><p>musclesim " MUSCLESIM_VERSION;
  if (!origin.date.empty()) text += ", " + escapedXml(origin.date);
  text += fmt::format(". Recordings: {}.</p>\n", escapedXml(fmt::format("{}", fmt::join(d.recordings, ", "))));
  if (!origin.command_line.empty()) text += "<p><code>" + escapedXml(origin.command_line) + "</code></p>\n";
  return text + "</footer>\n";
}

}  // namespace

std::string diagnosisReport(const Diagnosis& d, const ReportOrigin& origin) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width,initial-scale=1\"><title>Diagnosis of the sim-to-real gap</title><style>" +
         reportStyle() + "</style></head><body>\n<h1><b>Diagnosis of the sim-to-real gap.</b> " + escapedXml(subject(d)) + "</h1>\n" +
         (d.partial ? paragraph("Interrupted: this page holds only the results up to the interruption.") : "") + verdictBox(d) + where(d) +
         which(d) + howFar(d) + curves(d) + loops(d) + tuned(d) + whatElse(d) + foot(d, origin) + glossary() + reportScript() +
         "</body></html>\n";
}

}  // namespace musclesim
