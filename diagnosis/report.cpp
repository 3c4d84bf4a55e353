// report.html: one page, self-contained.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "../log/svg.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/version.h"
#include "report_figures.h"
#include "sentences.h"

namespace musclesim {

namespace {

constexpr const char* style = R"(body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:60rem;margin:1rem auto;padding:0 1rem}
h1{font-size:1.5rem}h2{font-size:1.15rem;border-bottom:1px solid #ccc;margin-top:2rem}
.verdict{font-size:1.25rem;padding:.8rem 1rem;border-left:.4rem solid #333;background:#f3f3f3}
body{overflow-wrap:break-word}table{border-collapse:collapse;width:100%}td,th{text-align:left;padding:.2rem .6rem;border-bottom:1px solid #ddd;vertical-align:top}
@media(max-width:36rem){td,th{padding:.2rem .3rem;font-size:.85rem}}
td.number,th.number{text-align:right;font-variant-numeric:tabular-nums}
svg{max-width:100%;height:auto;display:block;margin:.5rem 0}code{font-size:.9em}
.scroll,.trace{overflow-x:auto}.trace svg{min-width:36rem}@media print{.screen{display:none}.scroll,.trace{overflow:visible}.trace svg{min-width:0}body{max-width:none}h2{break-after:avoid}svg,table{break-inside:avoid}})";

std::string heading(const std::string& words) {
  return "<h2>" + words + "</h2>\n";
}

/// A label that may be broken after every word of it.
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

/// What the robot's drawing shows in colour: the place that the signals show, or else where the best explanation acts.
std::string drawing(const Diagnosis& d) {
  if (isLocated(d.where)) return robotFigure(d.drawing, d.where.front());
  const auto best =
      std::ranges::find_if(d.effects, [&](const FoundEffect& effect) { return !d.chosen.empty() && effect.label() == d.chosen.front(); });
  if (best == d.effects.end()) return robotFigure(d.drawing, {});
  return robotFigure(d.drawing, {nameOf(effectInfo(best->id).stage), best->component, {}}) +
         paragraph(fmt::format("In colour, where it can be drawn: {}, where the best explanation acts.", componentWords(best->component)));
}

std::string where(const Diagnosis& d) {
  if (d.where.empty()) return "";
  return heading("Where") + paragraph("A sample goes from command to pressure, force, body and sensor. " + whereSentence(d) + ".") +
         stagesFigure(d.where) + drawing(d) + paragraph("How this was told: " + d.where_method + ".");
}

bool triedAlone(const Diagnosis& d, const FoundEffect& effect) {
  return std::ranges::any_of(d.trials, [&](const Trial& trial) { return trial.effects.size() == 1 && trial.effects[0] == effect.label(); });
}

std::string which(const Diagnosis& d) {
  if (d.effects.empty()) return "";
  std::string rows;
  for (const FoundEffect& effect : d.effects) {
    std::string parameters;
    for (const auto& [name, estimate] : effect.parameters)
      if (estimate.value != 0 || estimate.low != 0 || estimate.high != 0)
        parameters += fmt::format("{}{} = {:.4g} ({:.4g} to {:.4g})", parameters.empty() ? "" : "<br>", breakable(name), estimate.value,
                                  estimate.low, estimate.high);
    rows += fmt::format("<tr><td>{}</td><td class=number>{}</td><td>{}</td><td class=number>{}</td></tr>\n", breakableCode(effect.label()),
                        probabilityWords(effect.probability), parameters,
                        triedAlone(d, effect) ? percentWords(effect.shrink_percent) : "not tried alone");
  }
  rows += fmt::format("<tr><td>none of these</td><td class=number>{}</td><td></td><td></td></tr>\n", probabilityWords(d.none_of_these));
  std::string text = heading("Which") +
                     "<div class=scroll><table><tr><th>effect</th><th class=number>probability</th><th>parameters (95 % interval)</th>"
                     "<th class=number>removes alone</th></tr>\n" +
                     rows + "</table></div>\n";
  if (!d.alternatives.empty()) text += paragraph(fmt::format("These recordings cannot tell apart: {}.", fmt::join(d.alternatives, ", ")));
  return text;
}

/// Whether there is a model with effects to set against the one without.
bool hasAfter(const Diagnosis& d) {
  return !d.chosen.empty() || !d.attempt.effects.empty();
}

std::string signalTable(const Diagnosis& d) {
  const auto cell = [](double value) { return fmt::format("<td class=number>{:.3g}</td>", value); };
  std::string rows;
  const Gap& gap_after = d.attempt.effects.empty() ? d.after : d.attempt.after;
  for (const auto& [name, before] : d.before.per_signal) {
    const auto after = gap_after.per_signal.find(name);
    rows += "<tr><td><code>" + name + "</code></td>" + cell(before.rmse);
    if (hasAfter(d)) rows += cell(after == gap_after.per_signal.end() ? before.rmse : after->second.rmse);
    rows += cell(before.noise_floor) + "</tr>\n";
  }
  const std::string residuals =
      hasAfter(d) ? "<th class=number>RMSE before</th><th class=number>RMSE after</th>" : "<th class=number>RMSE</th>";
  return "<div class=scroll><table><tr><th>signal</th>" + residuals + "<th class=number>noise floor</th></tr>\n" + rows +
         "</table></div>\n";
}

/// What an explanation gains beside what gains nothing in understanding.
std::string shrinkFigure(const Diagnosis& d) {
  std::vector<Bar> all;
  auto add = [&](const std::string& label, double left_percent, bool strong) {
    all.push_back({label, left_percent, leftWords(left_percent), strong});
  };
  add("gap before", 100, false);
  add("after re-tuning the model (nominal refit)", 100 - d.nominal_refit_shrink_percent, false);
  add("after a sham disturbance", 100 - d.sham_shrink_percent, false);
  if (d.attempt.effects.empty())
    add("after adding what was found", d.unexplained_percent, true);
  else
    add("after adding what comes nearest", 100 - d.attempt.shrink_percent, true);
  return barsFigure("What is left of the gap", all, std::max({100.0, 100 - d.nominal_refit_shrink_percent, 100 - d.sham_shrink_percent}));
}

std::string regimeFigure(const Diagnosis& d) {
  std::vector<Bar> all;
  double full = 1;
  for (const RegimeGap& regime : d.regimes) {
    full = std::max({full, regime.before, regime.after});
    all.push_back({"while " + regime.regime + (hasAfter(d) ? ", before" : ""), regime.before, fmt::format("{:.3g}", regime.before), false});
    if (hasAfter(d) && regime.after > 0) all.push_back({"after", regime.after, fmt::format("{:.3g}", regime.after), true});
  }
  if (all.empty()) return "";
  return paragraph("Residual in units of the noise floor (1 is as good as it gets):") + barsFigure("Residual by regime", all, full);
}

std::string howFar(const Diagnosis& d) {
  std::string text = heading(hasAfter(d) ? "How far" : "How close the model comes") + paragraph("Measured on " + d.held_out + ".");
  if (!d.chosen.empty())
    text += shrinkFigure(d) +
            paragraph(fmt::format(
                "Normalised gap before {:.3g}, after {:.3g}: {} removed. Elsewhere means on another recording of this plant. The "
                "nominal refit re-tunes numbers of the model without any effect ({}); the sham is a disturbance without physical "
                "meaning with as many parameters.",
                d.before.normalised, d.after.normalised,
                shrinkElsewhereWords({d.shrink_percent, d.shrink_low_percent, d.shrink_high_percent}), fmt::join(d.refitted, ", ")));
  if (!d.attempt.effects.empty())
    text += shrinkFigure(d) +
            paragraph(
                fmt::format("Nothing was found that deserves belief. What comes nearest: {}. Normalised gap before {:.3g}, with it {:.3g}: "
                            "{} removed. Elsewhere means on another recording of this plant. \"After\" below means: with this.",
                            fmt::join(d.attempt.effects, ", "), d.before.normalised, d.attempt.after.normalised,
                            shrinkElsewhereWords({d.attempt.shrink_percent, d.attempt.shrink_low_percent, d.attempt.shrink_high_percent})));
  text += regimeFigure(d) + signalTable(d);
  if (d.verdict == Verdict::no_gap)
    text += paragraph("What is smaller than the noise floor stays unseen, and so does what these commands did not bring out.");
  if (!d.traces.empty()) text += "<p class=screen>Drag over a plot to zoom all of them in time, double click to see everything.</p>\n";
  for (const Trace& trace : d.traces) text += traceFigure(trace, hasAfter(d));
  return text;
}

/// The model that everything is measured against, where parts of it were fitted.
std::string tuned(const Diagnosis& d) {
  if (d.tuned.empty()) return "";
  std::string rows;
  const bool together = hasAfter(d);
  for (const TunedParameter& p : d.tuned) {
    rows += fmt::format("<tr><td>{}</td><td class=number>{:.4g} {}</td><td class=number>{:.4g} ({:.4g} to {:.4g})</td>",
                        breakableCode(p.name), p.start, p.unit, p.fitted.value, p.fitted.low, p.fitted.high);
    if (together)
      rows += fmt::format("<td class=number>{:.4g} ({:.4g} to {:.4g})</td>", p.with_effects.value, p.with_effects.low, p.with_effects.high);
    rows += "</tr>\n";
  }
  return heading("The model") +
         paragraph(
             "Nobody measured these numbers of the model. They were fitted first, without any effect and without the held-out data; every "
             "gap \"before\" on this page is that of the model with these numbers. They were fitted again together with every effect that "
             "was tried, since either could stand in for the other. nominal.toml holds the last column, for --config.") +
         "<div class=scroll><table><tr><th>number</th><th class=number>given</th><th class=number>fitted (95 % interval)</th>" +
         (together ? "<th class=number>fitted with the effects</th>" : "") + "</tr>\n" + rows + "</table></div>\n";
}

/// What each effect alone could remove by the first look.
std::string looks(const Diagnosis& d) {
  constexpr std::size_t shown = 12;
  if (d.looks.empty()) return "";
  std::vector<Bar> all;
  for (std::size_t i = 0; i < std::min(shown, d.looks.size()); ++i) {
    const bool fitted = std::ranges::any_of(
        d.trials, [&](const Trial& trial) { return std::ranges::find(trial.effects, d.looks[i].effect) != trial.effects.end(); });
    all.push_back({d.looks[i].effect, d.looks[i].removed, fmt::format("{:.0f} %", 100 * d.looks[i].removed), fitted});
  }
  return paragraph(fmt::format(
             "{} effects on components were looked at. How much of the logarithm of the gap each would remove if its response were "
             "proportional to its strength; the dark ones were fitted:",
             d.looks.size())) +
         barsFigure("First look", all, 1);
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
    text += heading("Next experiment") + paragraph(fmt::format("To tell {} apart, play the commands in next.csv: {}.",
                                                               fmt::join(d.next_experiment.separates, ", "), d.next_experiment.why));
  if (!d.not_excited.empty())
    text += heading("Not excited") +
            paragraph("These recordings could not have shown: " + groupedWords(d.not_excited) + ". They may be present.");
  if (!d.chosen.empty() || !d.attempt.effects.empty()) {
    const std::string options =
        std::string(d.tuned.empty() ? "" : "--config nominal.toml ") + "--effects " + (d.chosen.empty() ? "attempt.json" : "effects.json");
    text += heading("Use it") + "<p><code>musclesim replay NEW.csv " + options + "</code> and <code>musclesim " +
            escapedXml(d.model_options) + " " + options + "</code> run the model with what " +
            (d.chosen.empty() ? "comes nearest" : "was found") + ".</p>\n";
  }
  text += heading("How it was computed") +
          paragraph(fmt::format("musclesim {}; robot {}; recordings {}; {} simulations of {:.0f} s in all, {:.0f} s on the clock.",
                                MUSCLESIM_VERSION, d.robot, fmt::join(d.recordings, ", "), d.simulation_count, d.simulated_s, d.wall_s));
  text += looks(d);
  if (d.notes.empty()) return text;
  text += "<p>Notes:</p><ul>\n";
  for (const std::string& note : d.notes) text += "<li>" + escapedXml(note) + "</li>\n";
  text += "</ul>\n";
  return text;
}

}  // namespace

std::string diagnosisReport(const Diagnosis& d) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width,initial-scale=1\">"
         "<title>Diagnosis of the sim-to-real gap</title><style>" +
         std::string(style) + "</style></head><body>\n<h1>Diagnosis of the sim-to-real gap</h1>\n" +
         (d.partial ? paragraph("Interrupted: this page holds only what was known by then.") : "") + "<p class=verdict>" +
         escapedXml(verdictSentence(d)) + "</p>\n" + where(d) + which(d) + howFar(d) + tuned(d) + whatElse(d) + zoomScript() +
         "</body></html>\n";
}

}  // namespace musclesim
