// The box at the head of report.html: what to believe, where, how sure, how much is left, what to do next.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "../../log/svg.h"
#include "../data/noise_sigma.h"
#include "../words/effect_words.h"
#include "../words/fitted_numbers.h"
#include "../words/sentences.h"
#include "musclesim/effect/catalogue.h"
#include "report_page.h"
#include "report_parts.h"
#include "report_shared.h"

namespace musclesim::report {

namespace {

struct SignWords {
  const char *look, *word;
  std::string sentence;
};

/// Where the motion is sensitive or something else is left, and no other cause would do as well.
std::string sentenceOfPart(const Diagnosis& d) {
  const bool are_several = d.chosen.size() > 1;
  if (isNoticeable(d.unsteady))
    return fmt::format("The motion is sensitive: believe the {} only as far as the percentages below say, and record gentler motions.",
                       are_several ? "causes" : "cause");
  const char *causes = are_several ? "causes" : "cause", *their = are_several ? "their" : "its";
  const std::vector<FoundEffect> shown = shownEffects(d);
  if (!std::ranges::all_of(shown, holdsOnUnseenData))
    return "Not every cause below holds on the data not used for fitting: one may stand in for something else.";
  if (std::ranges::all_of(shown, [](const FoundEffect& effect) { return effect.probability >= nearly_sure; }))
    return fmt::format("Believe the place and the kind of the {}; {} numbers are rough, and something else is left.", causes, their);
  return fmt::format("Believe the {} only as far as the percentages below say; {} numbers are rough, and something else is left.", causes,
                     their);
}

/// "delay (dead time)", for every number that is beyond what is usual.
std::vector<std::string> unusualNumbers(const Diagnosis& d) {
  std::vector<std::string> numbers;
  for (const FoundEffect& effect : shownEffects(d))
    for (const ParameterLine& line : parameterLines(effect, comparedSignals(d)))
      if (line.is_beyond) numbers.push_back(fmt::format("{} ({})", line.label, effectTitle(effect.id)));
  return numbers;
}

/// Where everything is explained.
std::string sentenceOfAll(const Diagnosis& d) {
  const char *causes = d.chosen.size() > 1 ? "causes" : "cause", *their = d.chosen.size() > 1 ? "their" : "its";
  const std::vector<std::string> unusual = unusualNumbers(d);
  if (unusual.empty()) return fmt::format("You can believe place, kind and numbers of the {} below.", causes);
  return fmt::format("You can believe the place of the {} below. Check the kind and {} numbers: {} {} beyond what is usual.", causes, their,
                     listed(unusual), unusual.size() > 1 ? "are" : "is");
}

/// Where another explanation is about as good.
std::string sentenceOfAmbiguity(const Diagnosis& d) {
  const char* these = d.chosen.size() > 1 ? "these" : "this one";
  if (d.next_experiment.commands.empty())
    return fmt::format("Other causes would explain these recordings as well, and no test signal known here tells them from {}.", these);
  return fmt::format("Other causes would explain these recordings as well: record more before you rely on {}.", these);
}

/// Where a number that was taken as exact would do what a cause does.
std::string sentenceOfNumbers(const Diagnosis& d) {
  return std::string("A wrong number of the model would do what a cause does: measure it before you rely on that cause.") +
         (isRestLeft(d) ? " Something else is left." : "");
}

SignWords signWords(const Diagnosis& d, Belief belief) {
  switch (belief) {
    case Belief::explained:
      return {"explained", "Explained", sentenceOfAll(d)};
    case Belief::partly:
      return {"partly", "Explained in part",
              isAmbiguous(d)              ? sentenceOfAmbiguity(d)
              : d.numbers_instead.empty() ? sentenceOfPart(d)
                                          : sentenceOfNumbers(d)};
    case Belief::cannot_tell:
      return {"cannot_tell", "Cannot tell", "Believe none of the causes yet."};
    case Belief::no_gap:
      return {"no_gap", "No gap",
              isExplainedByNumbers(d) ? "You can believe the model with the fitted numbers for motions like these."
                                      : "You can believe the model for motions like these."};
  }
  return {};
}

/// The answer where no cause is believed.
std::string headlineWithoutCause(const Diagnosis& d) {
  if (d.verdict != Verdict::unexplained || d.partial || d.held_out_is_noise) {
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
  if (d.small_gap) return "<p>Not looked for.</p>";
  if (isExplainedByNumbers(d)) return "<p>In numbers of the model; no effect is needed.</p>";
  if (d.verdict == Verdict::no_gap || d.verdict == Verdict::not_excited) return "<p>Nowhere: no signal stands out of its noise.</p>";
  const std::string seen = d.where.empty() ? "" : whereSentence(d) + ".";
  if (d.chosen.empty()) return seen.empty() ? "<p>Not known.</p>" : paragraph(seen);
  std::vector<std::string> places;
  std::vector<std::string> unconfirmed;
  for (const FoundEffect& effect : shownEffects(d)) {
    const std::string stage = nameOf(effectInfo(effect.id).stage);
    const std::string place = fmt::format("in the {} stage ({})", stage, ownerWords(effect.id, effect.component));
    if (isLocated(d.where) && !mayBeAt(d.where, stage) && std::ranges::find(unconfirmed, stage) == unconfirmed.end())
      unconfirmed.push_back(stage);
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  }
  return paragraph(fmt::format("{} {}.{}", d.chosen.size() > 1 ? "The causes act" : "The cause acts", listed(places),
                               unconfirmed.empty() ? ""
                                                   : fmt::format(" The signals alone do not confirm the {} stage{}.", listed(unconfirmed),
                                                                 unconfirmed.size() > 1 ? "s" : ""))) +
         (seen.empty() ? "" : "<p class=small>From the signals alone: " + escapedXml(seen) + "</p>");
}

/// The signal that stands out most.
std::string largestResidual(const Diagnosis& d) {
  const auto most = std::ranges::max_element(d.before.per_signal, {}, [](const auto& entry) { return overNoise(entry.second); });
  if (most == d.before.per_signal.end()) return "";
  return fmt::format(" The largest residual{} is {:.3g} times its noise floor ({}).",
                     isExplainedByNumbers(d) ? " of the model as it was given" : "", overNoise(most->second), signalTitle(most->first));
}

/// The explanations that are as good as the best one.
std::string alternativesSentence(const Diagnosis& d, const Caveats& caveats) {
  constexpr std::size_t told = 3;
  if (d.effects.empty() || d.none_of_these > rather_none) return "";
  if (d.ambiguity_sets.size() < 2) return caveats.others;
  if (const std::vector<std::string> shared = sharedEffects(d); !shared.empty())
    return fmt::format("These recordings leave {} explanations possible. All hold {}; they differ in what else acts.",
                       d.ambiguity_sets.size(), effectTitles(shared));
  std::vector<std::string> others;
  const bool is_chosen_first = !d.chosen.empty();
  for (std::size_t i = is_chosen_first ? 1 : 0; i < d.ambiguity_sets.size() && others.size() < told; ++i)
    others.push_back(effectTitles(d.ambiguity_sets[i]));
  const std::size_t more = d.ambiguity_sets.size() - others.size() - (is_chosen_first ? 1 : 0);
  return fmt::format("{}: {}{}.", is_chosen_first ? likelihoodOfOthers(d) : "Possible", fmt::join(others, ", or "),
                     more ? fmt::format(", or {} more", more) : "");
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
                          together < only->probability - worth_telling && d.remainder.probability < rather_none
                              ? "; that nothing else acts, " + probabilityWords(together)
                              : "");
    else if (together > 0)
      text += fmt::format("<p>This explanation has a {} of {} as a whole; each cause has its own below.</p>", term("probability"),
                          probabilityWords(together));
  }
  text += paragraph(alternativesSentence(d, caveats));
  if (!d.small_gap && (d.verdict == Verdict::no_gap || d.verdict == Verdict::not_excited))
    text += fmt::format(
        "<p>A residual is called noise up to {} times its {} in all recordings together ({} where the floor was estimated from "
        "quiet rows), and a little more in a single one.{}</p>",
        out_of_noise, term("floor"), out_of_estimated_noise, largestResidual(d));
  text += paragraph(caveats.none) + paragraph(caveats.numbers) + paragraph(caveats.unsteady) + paragraph(caveats.model);
  if (d.small_gap && text.empty()) return "<p>Causes of a gap this small were not looked for.</p>";
  if (d.verdict == Verdict::unexplained && text.empty()) return "<p>No explanation is believed.</p>";
  return text;
}

std::string restAnswer(const Diagnosis& d, const Caveats& caveats) {
  if (d.small_gap) return paragraph(smallGapSentence(d));
  if (d.verdict == Verdict::no_gap)
    return isExplainedByNumbers(d)
               ? "<p>Nothing beyond the noise with the fitted numbers." + (" " + escapedXml(fittedNumbersSentence(d))) + "</p>"
               : "<p>Nothing beyond the noise.</p>";
  if (d.verdict == Verdict::not_excited) return "<p>Nothing beyond the noise, but the recordings hardly move the machine.</p>";
  if (d.verdict == Verdict::effects_found) {
    const std::string noise =
        fmt::format("The {} is {:.1f} times the {}: {}.", term("residual"), overNoiseInAll(d.after), term("floor"),
                    d.remainder.is_significant ? fmt::format("little, but more than noise ({:.1f} times it in {})", d.remainder.in_sigmas,
                                                             escapedXml(signalTitle(d.remainder.signal)))
                                               : "noise, or nearly so");
    return fmt::format("<p>{} of the gap. {}</p>", capitalised(leftWords(d.unexplained_percent)),
                       caveats.rest.empty() ? noise : escapedXml(caveats.rest)) +
           paragraph(elsewhereSentence({d.reduction_percent, d.reduction_low_percent, d.reduction_high_percent}));
  }
  std::string text = fmt::format("<p>All of it, since no cause is believed: the {} is {:.3g} times the {}.{}</p>", term("residual"),
                                 overNoiseInAll(d.before), term("floor"), escapedXml(largestResidual(d))) +
                     paragraph(fittedNumbersSentence(d));
  if (d.attempt.effects.empty()) return text;
  return text + fmt::format("<p>The best {}, {}, would leave {}.</p>", term("attempt"), escapedXml(effectTitles(d.attempt.effects)),
                            leftWords(percentLeft(d)));
}

std::string foundSteps(const Diagnosis& d, Belief belief) {
  std::string steps = fmt::format("<li>Add {} to the model: {}.</li>", d.chosen.size() > 1 ? "these causes" : "this cause",
                                  command("musclesim replay NEW.csv " + fileOptions(d)));
  if (!d.next_experiment.commands.empty())
    steps += fmt::format(
        "<li>Play and record <code>next.csv</code>, then diagnose again with that recording first: it tells the "
        "alternatives apart{}.</li>",
        d.next_experiment.difference < 1
            ? fmt::format(" better than other motions, although two of them differ by only {:.1f} times the noise there",
                          d.next_experiment.difference)
            : "");
  if (belief == Belief::partly && isRestLeft(d)) {
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
        (isExplainedByNumbers(d) ? fmt::format("<li>Use the model with the fitted numbers: {}.</li>",
                                               command("musclesim replay NEW.csv --config nominal.toml" + substepsOption(d)))
         : d.substeps > 0        ? fmt::format("<li>Use the model as it is, in the internal steps of this diagnosis: {}.</li>",
                                               command("musclesim replay NEW.csv" + substepsOption(d)))
                                 : "<li>Use the model as it is.</li>") +
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

}  // namespace

std::string verdictBox(const Diagnosis& d) {
  const Belief belief = beliefOf(d);
  const SignWords sign = signWords(d, belief);
  const Caveats caveats = caveatsOf(d);
  const auto row = [](const std::string& head, const std::string& text) { return "<dt>" + head + "</dt><dd>" + text + "</dd>\n"; };
  return fmt::format(
      "<section class=\"verdict {}\"><div class=signal>{}<div><strong>{}</strong>{}</div></div>\n{}<dl "
      "class=answers>\n{}{}{}{}</dl></section>\n",
      sign.look, signFigure(belief), sign.word, sign.sentence, headline(d) + paragraph(caveats.instead), row("Where", whereAnswer(d)),
      row("How sure", sureAnswer(d, caveats)), row("How much is left", restAnswer(d, caveats)),
      row("What to do next", nextSteps(d, belief)));
}

}  // namespace musclesim::report
