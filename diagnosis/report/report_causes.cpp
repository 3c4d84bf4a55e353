// The sections "Where" and "Which causes" of report.html.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "../../log/svg.h"
#include "../words/effect_words.h"
#include "../words/sentences.h"
#include "effect_sketch.h"
#include "musclesim/effect/catalogue.h"
#include "report_page.h"
#include "report_parts.h"
#include "report_shared.h"

namespace musclesim::report {

namespace {

/// The robot with the components of the causes found in colour, or else the one to which the signals point.
std::string drawing(const Diagnosis& d) {
  if (d.drawing.lines.empty()) return "";
  std::vector<Place> places;
  std::string words = "The robot from the front.";
  const auto placeOf = [](const FoundEffect& effect) { return Place{nameOf(effectInfo(effect.id).stage), effect.component, {}}; };
  if (!d.chosen.empty()) {
    for (const FoundEffect& effect : shownEffects(d)) places.push_back(placeOf(effect));
    words += " The parts on which the causes found act are in colour.";
  } else if (isLocated(d.where)) {
    places = {d.where.front()};
    words += fmt::format(" The part where the gap arises is in colour ({}).", componentWords(places.front().component));
  }
  return "<div class=robot>" + robotFigure(d.drawing, places) + small(words) + "</div>\n";
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

/// "removes 96.2 % of the gap alone", or that it makes the gap larger.
std::string removal(double percent, const char* how) {
  return percent < 0 ? fmt::format("makes the gap larger {}", how) : fmt::format("removes {} of the gap {}", percentWords(percent), how);
}

std::string effectCard(const FoundEffect& effect, const Diagnosis& d) {
  std::string facts;
  if (effect.probability > 0) facts = fmt::format("Probability {}. ", probabilityWords(effect.probability));
  std::vector<std::string> removals;
  if (effect.reduction_percent) removals.push_back(removal(*effect.reduction_percent, "alone"));
  if (effect.removes_percent && d.chosen.size() > 1) removals.push_back(removal(*effect.removes_percent, "beside the others"));
  if (!removals.empty()) facts += capitalised(fmt::format("{}.", fmt::join(removals, ", and ")));
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
        !effect.reduction_percent       ? "not tried"
        : *effect.reduction_percent < 0 ? "nothing"
                                        : percentWords(*effect.reduction_percent));
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

}  // namespace

std::string where(const Diagnosis& d) {
  if (d.where.empty()) return "";
  const bool is_elsewhere = isLocated(d.where) && std::ranges::any_of(d.where, [&](const Place& p) {
                              return isFoundAt(d, p.stage) && !mayBeAt(d.where, p.stage);
                            });
  return heading("Where") + "<div class=place><div>" +
         lead("A sample passes five " + term("stage", "stages") + ". The darker a box, the likelier " +
              (is_elsewhere ? "most of the gap" : "the gap") + " arises there, by the signals alone" +
              (isLocated(d.where) ? "; a thick red frame marks where they leave no other choice:" : ":")) +
         "<figure>" + stagesFigure(d) + "</figure>" + paragraph("Evidence: " + d.where_method + ".") + "</div>" + drawing(d) + "</div>\n";
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

}  // namespace musclesim::report
