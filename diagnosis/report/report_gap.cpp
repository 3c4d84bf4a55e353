// The sections "How far", "Curves" and "Loops" of report.html.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "../../base/short_names.h"
#include "../../log/svg.h"
#include "../data/loop_pairs.h"
#include "../words/effect_words.h"
#include "../words/fitted_numbers.h"
#include "../words/sentences.h"
#include "musclesim/effect/catalogue.h"
#include "report_page.h"
#include "report_parts.h"
#include "report_shared.h"

namespace musclesim::report {

namespace {

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
         small(d.refitted.empty() ? "This model has no number to re-tune."
                                  : fmt::format("Re-tuned were: {}.", fmt::join(d.refitted, ", ")));
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

}  // namespace

namespace {

/// The numbers with which the model agrees with the recordings.
std::string fittedNumbersTable(const Diagnosis& d) {
  std::string rows;
  for (const FittedNumber& number : d.numbers)
    rows += fmt::format(
        "<tr><td data-head=number>{}</td><td class=number data-head=given>{:.4g} {}</td><td class=number data-head=fitted>{}</td></tr>\n",
        breakableCode(number.name), number.start, number.unit, estimateWords(number.fitted));
  return paragraph(fmt::format("These are gaps of the model as it was given. With the numbers below, fitted within their tolerances "
                               "(nominal.toml), {} of the gap on {} is removed.",
                               percentWords(d.reduction_percent), d.held_out)) +
         "<table class=wide><thead><tr><th>number</th><th class=number>given</th><th class=number>fitted (95 % "
         "interval)</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>";
}

}  // namespace

std::string howFar(const Diagnosis& d) {
  const bool searched = d.verdict == Verdict::effects_found || d.verdict == Verdict::unexplained;
  std::string text = heading(hasAfter(d) ? "How far" : "How close the model comes");
  text += lead(escapedXml(searched ? "Measured on " + d.held_out + "."
                                   : fmt::format("All {} recordings were compared; the figures below are of {}.", d.recordings.size(),
                                                 shortNames(d.recordings).back())));
  for (const std::string& odd : d.odd_recordings) text += paragraph(odd);
  if (!d.unknown_start.empty()) text += paragraph(d.unknown_start);
  if (hasAfter(d) && d.chosen.empty()) text += paragraph("No explanation was accepted: below, \"after\" means with the best rejected one.");
  if (hasAfter(d)) text += removalFigure(d) + controlsFigure(d);
  text += phaseFigure(d) + signalTable(d);
  if (isExplainedByNumbers(d))
    text += fittedNumbersTable(d);
  else if (!searched)
    text +=
        paragraph("A smaller difference than these is not seen, nor is an effect that these commands do not excite: no effect was fitted.");
  return text;
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

std::string loops(const Diagnosis& d) {
  const auto acts_behind_pressure = [](const FoundEffect& effect) {
    const Stage stage = effectInfo(effect.id).stage;
    return stage == Stage::force || stage == Stage::body;
  };
  const std::vector<FoundEffect> shown = shownEffects(d);
  if (d.verdict == Verdict::effects_found && std::ranges::none_of(shown, acts_behind_pressure)) return "";
  constexpr std::size_t most_loops = 8;
  std::vector<TimedSignal> signals;
  signals.reserve(d.traces.size());
  for (const Trace& trace : d.traces) signals.push_back({trace.signal, trace.time_s, trace.measured});
  std::vector<std::pair<std::size_t, std::size_t>> pairs = loopPairs(signals);
  if (pairs.size() > most_loops) pairs.resize(most_loops);
  std::string figures;
  for (const auto& [pressure, motion] : pairs) figures += loopFigure(loopOf(d.traces[pressure], d.traces[motion]));
  if (figures.empty()) return "";
  return heading("Loops") + lead("The same data without time: friction and hysteresis open a loop, a wrong force law bends or shifts it.") +
         "<div class=loops>" + figures + "</div>\n";
}

}  // namespace musclesim::report
