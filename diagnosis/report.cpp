// report.html: one page, self-contained.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <variant>

#include "../log/svg.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/version.h"
#include "noise_sigma.h"
#include "report_figures.h"
#include "sentences.h"

namespace musclesim {

namespace {

constexpr const char* style = R"(body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:60rem;margin:1rem auto;padding:0 1rem}
h1{font-size:1.5rem}h2{font-size:1.15rem;border-bottom:1px solid #ccc;margin-top:2rem}
.verdict{padding:.4rem 1rem;border-left:.4rem solid #333;background:#f3f3f3}.verdict p{font-size:1.15rem;margin:.4rem 0}.verdict p.small,.small{font-size:.9rem;color:#555}
body{overflow-wrap:break-word}table{border-collapse:collapse;width:100%}td,th{text-align:left;padding:.2rem .6rem;border-bottom:1px solid #ddd;vertical-align:top}
@media(max-width:36rem){td,th{padding:.2rem .3rem;font-size:.85rem}}
td.number,th.number{text-align:right;font-variant-numeric:tabular-nums}
svg{max-width:100%;height:auto;display:block;margin:.5rem 0}code{font-size:.9em}
.scroll,.trace{overflow-x:auto}.scroll svg{min-width:32rem}.trace svg{min-width:36rem}.trace h3{font-size:1rem;margin:.8rem 0 0;position:sticky;left:0}.lead{break-after:avoid}
.bars{margin:.7rem 0}.bar{display:grid;grid-template-columns:19rem 1fr;gap:.5rem;align-items:center;margin:.15rem 0;font-size:.9rem;break-inside:avoid}.bar>:first-child{text-align:right}
.length{display:flex;align-items:center;gap:.5rem}.fill{border-top:.9rem solid #8a8a8a;min-width:1px}.strong{border-top-color:#222}@media screen and (max-width:44rem){.bar{display:block}.bar>:first-child{text-align:left}}
.place{display:flex;gap:1.5rem}.place>:first-child{flex:1}.robot{flex:0 0 17rem}@media screen and (max-width:44rem){.place{display:block}}
@media print{.screen{display:none}.scroll,.trace{overflow:visible}.scroll svg,.trace svg{min-width:0}body{max-width:none;font-size:14px}h2,h3{break-after:avoid}svg,tr,.trace{break-inside:avoid}tr:first-child{break-after:avoid}})";

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
  return "<p>" + escapedXml(words) + "</p>\n";
}

/// A paragraph that introduces the following figure or table.
std::string lead(const std::string& words) {
  return "<p class=lead>" + escapedXml(words) + "</p>\n";
}

std::string small(const std::string& words) {
  return "<p class=small>" + escapedXml(words) + "</p>\n";
}

/// Content that scrolls sideways on narrow pages.
std::string sliding(const std::string& content) {
  return "<div class=scroll>" + content + "</div>\n";
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
         lead("A sample goes from command to pressure, force, body and sensor: the darker a box, the likelier the gap arises there.") +
         stagesFigure(d.where) + paragraph("Evidence: " + d.where_method + ".") + "</div>" + drawing(d) + "</div>\n";
}

/// A remark on a fitted number at its bound or outside the usual range.
std::string remarkOn(const EffectParameter& parameter, double value) {
  if (!parameter.choices.empty() || value == parameter.neutral) return "";
  if (value == parameter.minimum || value == parameter.maximum) return ", at its bound";
  if (value >= parameter.usual_low && value <= parameter.usual_high) return "";
  return fmt::format(", usual range {:.4g} to {:.4g}", parameter.usual_low, parameter.usual_high);
}

std::string parameterRows(const FoundEffect& effect) {
  std::string rows;
  const EffectInfo info = effectInfo(effect.id);
  for (const auto& [name, word] : effect.choices) rows += fmt::format("{}{} = {}", rows.empty() ? "" : "<br>", breakable(name), word);
  for (const auto& [name, estimate] : effect.parameters) {
    if (isLeftOut(estimate)) continue;
    const auto parameter = std::ranges::find(info.parameters, name, &EffectParameter::name);
    rows += fmt::format("{}{} = {}{}", rows.empty() ? "" : "<br>", breakable(name), estimateWords(estimate),
                        parameter == info.parameters.end() ? "" : remarkOn(*parameter, estimate.value));
  }
  return rows;
}

/// The probabilities of sets of effects, if any set has several.
std::string togetherWords(const Diagnosis& d) {
  if (std::ranges::none_of(d.explanations, [](const auto& fitted) { return fitted.effects.size() > 1; })) return "";
  std::vector<std::string> words;
  for (const ExplanationProbability& fitted : d.explanations)
    if (!fitted.effects.empty())
      words.push_back(fmt::format("{} {}", fmt::join(fitted.effects, " + "), probabilityWords(fitted.probability)));
  return fmt::format(" By explanation: {}.", fmt::join(words, ", "));
}

std::string which(const Diagnosis& d) {
  if (d.verdict == Verdict::no_gap || d.verdict == Verdict::not_excited || (d.effects.empty() && d.none_of_these == 0)) return "";
  std::string rows;
  for (const FoundEffect& effect : d.effects)
    rows += fmt::format("<tr><td>{}</td><td class=number>{}</td><td>{}</td><td class=number>{}</td><td class=number>{}</td></tr>\n",
                        breakableCode(effect.label()), probabilityWords(effect.probability), parameterRows(effect),
                        effect.reduction_percent ? percentWords(*effect.reduction_percent) : "not tried alone",
                        effect.removes_percent ? percentWords(*effect.removes_percent) : "");
  rows += fmt::format("<tr><td>none of these</td><td class=number>{}</td><td></td><td></td><td></td></tr>\n",
                      probabilityWords(d.none_of_these));
  std::string text =
      heading("Which") + sliding(
                             "<table><tr><th>effect</th><th class=number>probability</th><th>parameters (95 % "
                             "interval)</th><th class=number>removes alone</th><th class=number>removes beside the others</th></tr>\n" +
                             rows + "</table>");
  if (!d.effects.empty())
    text += small(
        "The probability of an effect is the sum over all explanations that contain it, so effects that act together can all be probable." +
        togetherWords(d) +
        " The intervals assume our law of the effect. The machine may follow another law: trust the place and the kind of the effect more "
        "than the last digit.");
  if (!d.effects.empty() && !d.alternatives.empty())
    text += paragraph(fmt::format("These recordings cannot distinguish: {}.", fmt::join(d.alternatives, ", ")));
  return text;
}

/// Whether there is a model with effects to compare with the one without.
bool hasAfter(const Diagnosis& d) {
  return !d.chosen.empty() || !d.attempt.effects.empty();
}

std::string signalTable(const Diagnosis& d) {
  const auto cell = [](double value) { return fmt::format("<td class=number>{:.3g}</td>", value); };
  const auto pair = [&](const SignalGap& gap) { return cell(gap.rmse) + fmt::format("<td class=number>{:.2f}</td>", overNoise(gap)); };
  std::string rows;
  const Gap& gap_after = d.attempt.effects.empty() ? d.after : d.attempt.after;
  for (const auto& [name, before] : d.before.per_signal) {
    const auto found = gap_after.per_signal.find(name);
    const SignalGap& after = hasAfter(d) && found != gap_after.per_signal.end() ? found->second : before;
    rows += "<tr><td>" + breakableCode(name) + "</td>" + cell(before.noise_sigma) + pair(before) + (hasAfter(d) ? pair(after) : "") +
            "<td>" + shapeOfRest(d, name) + "</td></tr>\n";
  }
  const auto heads = [](const std::string& when) {
    return "<th class=number>RMSE" + when + "</th><th class=number>RMSE / floor" + when + "</th>";
  };
  return sliding("<table><tr><th>signal</th><th class=number>noise floor</th>" +
                 (hasAfter(d) ? heads(" before") + heads(" after") : heads("")) + "<th>shape of the residual</th></tr>\n" + rows +
                 "</table>");
}

/// Bars of the remaining gap: with the effects found and with both controls.
std::string reductionFigure(const Diagnosis& d) {
  std::vector<Bar> all;
  auto add = [&](const std::string& label, double left_percent, bool strong) {
    all.push_back({label, left_percent, leftWords(left_percent), strong});
  };
  add("gap before", 100, false);
  add("after re-tuning the model (nominal refit)", 100 - d.nominal_refit_percent, false);
  add("after a disturbance without meaning (negative control)", 100 - d.negative_control_percent, false);
  if (d.attempt.effects.empty())
    add("after adding the effects found", d.unexplained_percent, true);
  else
    add("after adding the best rejected hypothesis", 100 - d.attempt.reduction_percent, true);
  return barsFigure("Remaining gap", all, std::max({100.0, 100 - d.nominal_refit_percent, 100 - d.negative_control_percent})) +
         small(fmt::format("The nominal refit re-tunes parameters of the model without any effect ({}). The negative control is a "
                           "disturbance of the commands that has no physical meaning and as many parameters.",
                           fmt::join(d.refitted, ", ")));
}

std::string phaseFigure(const Diagnosis& d) {
  std::vector<Bar> all;
  double full = 1;
  for (const PhaseGap& phase : d.phases) {
    full = std::max({full, phase.before, phase.after});
    all.push_back({"while " + phase.phase + (hasAfter(d) ? ", before" : ""), phase.before, fmt::format("{:.3g}", phase.before), false});
    if (hasAfter(d) && phase.after > 0) all.push_back({"after", phase.after, fmt::format("{:.3g}", phase.after), true});
  }
  if (all.empty()) return "";
  return lead("RMS residual over the noise floor (1: noise alone), while the commands rise (filling), fall (venting) and rest (holding):") +
         barsFigure("Residual by actuation phase", all, full);
}

/// The parameters of the best rejected hypothesis, which the table of effects may not list.
std::string attemptWords(const Attempt& attempt) {
  std::vector<std::string> words;
  for (const ActiveEffect& effect : attempt.active_effects) {
    std::vector<std::string> values;
    const EffectInfo info = effectInfo(effect.id);
    for (const auto& [name, value] : effect.parameters)
      if (const auto* number = std::get_if<double>(&value)) {
        const auto parameter = std::ranges::find(info.parameters, name, &EffectParameter::name);
        values.push_back(
            fmt::format("{} = {:.3g}{}", name, *number, parameter == info.parameters.end() ? "" : remarkOn(*parameter, *number)));
      } else if (const auto* word = std::get_if<std::string>(&value)) {
        values.push_back(fmt::format("{} = {}", name, *word));
      }
    words.push_back(fmt::format("{}@{} ({})", effect.id, effect.component, fmt::join(values, ", ")));
  }
  return fmt::format("{}", fmt::join(words, " together with "));
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

std::string howFar(const Diagnosis& d) {
  const bool searched = d.verdict == Verdict::effects_found || d.verdict == Verdict::unexplained;
  std::string text = heading(hasAfter(d) ? "How far" : "How close the model comes");
  text += paragraph(searched ? "Measured on " + d.held_out + "."
                             : fmt::format("All {} recordings were compared; the figures below are of {}.", d.recordings.size(),
                                           std::filesystem::path(d.recordings.back()).filename().string()));
  if (!d.chosen.empty())
    text += reductionFigure(d) +
            paragraph(fmt::format("Normalised gap (0 is the noise floor) before {:.3g}, after {:.3g}: {} removed. {}", d.before.normalised,
                                  d.after.normalised, percentWords(d.reduction_percent),
                                  elsewhereSentence({d.reduction_percent, d.reduction_low_percent, d.reduction_high_percent})));
  if (!d.attempt.effects.empty())
    text += reductionFigure(d) +
            paragraph(fmt::format(
                "No hypothesis was accepted. Best rejected hypothesis: {}. Normalised gap (0 is the noise floor) before {:.3g}, with this "
                "hypothesis {:.3g}: {} removed. {} Below, \"after\" means: with this hypothesis.",
                attemptWords(d.attempt), d.before.normalised, d.attempt.after.normalised, percentWords(d.attempt.reduction_percent),
                elsewhereSentence({d.attempt.reduction_percent, d.attempt.reduction_low_percent, d.attempt.reduction_high_percent})));
  text += phaseFigure(d) + signalTable(d);
  if (!searched)
    text +=
        paragraph(fmt::format("A signal agrees up to {} times its noise floor, {} times where the floor was estimated from quiet rows. A "
                              "smaller difference is not seen, nor is an effect that these commands do not excite: no effect was fitted.",
                              out_of_noise, out_of_estimated_noise));
  if (!d.traces.empty())
    text +=
        "<p class=screen>Drag over a plot to zoom all of them in time; double click, or <button type=button id=whole>show all</button>, to "
        "see everything.</p>\n";
  for (const Trace* trace : tracesByGap(d)) text += traceFigure(*trace, hasAfter(d));
  return text;
}

/// The tuned parameters of the model that everything is compared with.
std::string tuned(const Diagnosis& d) {
  if (d.tuned.empty()) return "";
  std::string rows;
  const bool together = hasAfter(d);
  for (const TunedParameter& p : d.tuned) {
    rows += fmt::format("<tr><td>{}</td><td class=number>{:.4g} {}</td><td class=number>{}</td>", breakableCode(p.name), p.start, p.unit,
                        estimateWords(p.fitted));
    if (together) rows += fmt::format("<td class=number>{}</td>", estimateWords(p.with_effects));
    rows += "</tr>\n";
  }
  return heading("The model") +
         paragraph(
             "Nobody measured these parameters of the model. They were fitted first, without any effect and without the held-out data; "
             "every gap \"before\" on this page is the gap of the model with these values. They were fitted again together with every "
             "effect that was tried, because a parameter and an effect can stand in for each other. nominal.toml holds the last column, "
             "for --config.") +
         sliding("<table><tr><th>parameter</th><th class=number>given</th><th class=number>fitted (95 % interval)</th>" +
                 std::string(together ? "<th class=number>fitted with the effects</th>" : "") + "</tr>\n" + rows + "</table>");
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
    all.push_back(
        {fmt::format("{}. {}", rank, screening.effect), screening.removed, fmt::format("{:.0f} %", 100 * screening.removed), fitted});
  }
  const std::string which = places.size() <= shown ? "" : fmt::format("; these are the first {} and the chosen ones", shown);
  return lead(fmt::format("{} screened{}. Each bar is the share of the logarithm of the gap that the effect would remove if its response "
                          "were proportional to its strength; a fit follows the true response and may remove more{}:",
                          counted(places.size(), "effect on a component was", "effects on components were"), which,
                          some_not_fitted ? "; the dark ones were fitted" : "")) +
         barsFigure("Screening", all, 1);
}

/// "leak (all components, muscle 0), creep (muscle 0)" from labels in this order.
std::string groupedWords(const std::vector<std::string>& labels) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;
  for (const std::string& label : labels) {
    const std::string id = label.substr(0, label.find('@')), component = componentWords(label.substr(label.find('@') + 1));
    auto group = std::ranges::find(groups, id, &std::pair<std::string, std::vector<std::string>>::first);
    if (group == groups.end()) group = groups.insert(groups.end(), {id, {}});
    if (std::ranges::find(group->second, component) == group->second.end()) group->second.push_back(component);
  }
  std::vector<std::string> words;
  for (auto& [id, components] : groups) {
    std::ranges::replace(id, '_', ' ');
    words.push_back(fmt::format("{} ({})", id, fmt::join(components, ", ")));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string whatElse(const Diagnosis& d) {
  std::string text;
  if (!d.next_experiment.commands.empty())
    text += heading("Next experiment") +
            paragraph(fmt::format(
                "{} {} apart, play the {:.0f} s of commands in next.csv, {}. Then run diagnose with the new recording as the first file, "
                "followed by the recordings of this page.",
                d.verdict == Verdict::unexplained ? "In case one of the known effects is the cause after all: to tell" : "To tell",
                fmt::join(d.next_experiment.separates, ", "), d.next_experiment.time_s.back(), d.next_experiment.why));
  if (!d.not_excited.empty())
    text += heading("Not excited") + paragraph("These recordings could not have shown the following effects, which may be present: " +
                                               groupedWords(d.not_excited) + ".");
  if (!d.chosen.empty() || !d.attempt.effects.empty()) {
    const std::string options =
        std::string(d.tuned.empty() ? "" : "--config nominal.toml ") + "--effects " + (d.chosen.empty() ? "attempt.json" : "effects.json");
    text +=
        heading("Use it") + "<p><code>musclesim replay NEW.csv " + options + "</code> and <code>musclesim " + escapedXml(d.model_options) +
        " " + options + "</code> run the model with " + (d.chosen.empty() ? "the best rejected hypothesis" : "the effects found") +
        (d.model_options.find("--set") == std::string::npos ? "" : "; replay takes the robot's parameters from the recording's sidecar") +
        ".</p>\n";
  }
  text += heading("How it was computed") +
          paragraph(fmt::format("musclesim {}; robot {}; recordings {}; {} simulations of {:.0f} s in all, {:.0f} s on the clock.",
                                MUSCLESIM_VERSION, d.robot, fmt::join(d.recordings, ", "), d.simulation_count, d.simulated_s, d.wall_s));
  text += screenings(d);
  if (d.notes.empty()) return text;
  text += "<p>Notes:</p><ul>\n";
  for (const std::string& note : d.notes) text += "<li>" + escapedXml(note) + "</li>\n";
  text += "</ul>\n";
  return text;
}

std::string verdict(const Diagnosis& d) {
  std::string text = "<div class=verdict>";
  for (const std::string& sentence : verdictSentences(d)) text += paragraph(sentence);
  if (d.verdict == Verdict::effects_found) text += small("In brackets: 95 % intervals.");
  return text + "</div>\n";
}

/// "Robot elbow; recordings r1.csv, r2.csv, r3.csv."
std::string subject(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const std::string& file : d.recordings) names.push_back(std::filesystem::path(file).filename().string());
  return fmt::format("Robot {}; recordings {}.", d.robot, fmt::join(names, ", "));
}

}  // namespace

std::string diagnosisReport(const Diagnosis& d) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width,initial-scale=1\"><title>Diagnosis of the sim-to-real gap</title><style>" +
         std::string(style) + "</style></head><body>\n<h1>Diagnosis of the sim-to-real gap</h1>\n" + small(subject(d)) +
         (d.partial ? paragraph("Interrupted: this page holds only the results up to the interruption.") : "") + verdict(d) + where(d) +
         which(d) + howFar(d) + tuned(d) + whatElse(d) + zoomScript() + "</body></html>\n";
}

}  // namespace musclesim
