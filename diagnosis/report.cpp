// report.html: one page, self-contained.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "../log/axis.h"
#include "../log/curve.h"
#include "../log/svg.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/version.h"
#include "sentences.h"

namespace musclesim {

namespace {

constexpr const char* style = R"(body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:60rem;margin:1rem auto;padding:0 1rem}
h1{font-size:1.5rem}h2{font-size:1.15rem;border-bottom:1px solid #ccc;margin-top:2rem}
.verdict{font-size:1.25rem;padding:.8rem 1rem;border-left:.4rem solid #333;background:#f3f3f3}
table{border-collapse:collapse;width:100%}td,th{text-align:left;padding:.2rem .6rem;border-bottom:1px solid #ddd;vertical-align:top}
td.number,th.number{text-align:right;font-variant-numeric:tabular-nums}
svg{max-width:100%;height:auto;display:block;margin:.5rem 0}code{font-size:.9em}
.scroll{overflow-x:auto}@media print{body{max-width:none}h2{break-after:avoid}svg,table{break-inside:avoid}})";

std::string heading(const std::string& words) {
  return "<h2>" + words + "</h2>\n";
}

std::string paragraph(const std::string& words) {
  return "<p>" + escapedXml(words) + "</p>\n";
}

/// Bars with a label on the left and a number on the right.
struct Bar {
  std::string label;
  double value;
  std::string number;
};

std::string bars(const std::string& title, const std::vector<Bar>& all, double full) {
  constexpr double width = 700, row = 26, left = 260, right = 90;
  Svg svg(width, row * static_cast<double>(all.size()) + 8, title);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double y = 4 + row * static_cast<double>(i) + row / 2;
    const double length = full > 0 ? (width - left - right) * std::clamp(all[i].value / full, 0.0, 1.0) : 0;
    svg.text({left - 8, y + 5}, all[i].label, {14, SvgAnchor::end, "#222222"});
    svg.line({left, y}, {left + std::max(1.0, length), y}, i % 2 ? "#777777" : "#333333", row * 0.55);
    svg.text({left + length + 8, y + 5}, all[i].number, {14, SvgAnchor::start, "#222222"});
  }
  return svg.document();
}

std::string where(const Diagnosis& d) {
  if (d.where.empty()) return "";
  std::vector<Bar> all;
  for (const char* stage : {"command", "pressure", "force", "body", "sensor"})
    for (const Place& place : d.where)
      if (place.stage == stage)
        all.push_back({place.stage + " (" + place.component + ")", place.share, fmt::format("{:.0f} %", 100 * place.share)});
  return heading("Where") + paragraph("A sample goes from command to pressure, force, body and sensor. " + whereSentence(d) + ".") +
         bars("Shares of the stages", all, 1) + paragraph("How this was told: " + d.where_method + ".");
}

std::string which(const Diagnosis& d) {
  if (d.effects.empty()) return "";
  std::string rows;
  for (const FoundEffect& effect : d.effects) {
    std::string parameters;
    for (const auto& [name, estimate] : effect.parameters)
      parameters += fmt::format("{}{} = {:.4g} ({:.4g} to {:.4g})", parameters.empty() ? "" : "<br>", name, estimate.value, estimate.low,
                                estimate.high);
    rows += fmt::format("<tr><td><code>{}</code></td><td class=number>{:.1f} %</td><td>{}</td><td class=number>{:.1f} %</td></tr>\n",
                        escapedXml(effect.label()), 100 * effect.probability, parameters, effect.shrink_percent);
  }
  rows += fmt::format("<tr><td>none of these</td><td class=number>{:.1f} %</td><td></td><td></td></tr>\n", 100 * d.none_of_these);
  std::string text = heading("Which") +
                     "<div class=scroll><table><tr><th>effect</th><th class=number>probability</th><th>parameters (95 % interval)</th>"
                     "<th class=number>removes alone</th></tr>\n" +
                     rows + "</table></div>\n";
  if (d.ambiguity_set.size() > 1)
    text += paragraph(fmt::format("These recordings cannot tell apart: {}.", fmt::join(d.ambiguity_set, ", ")));
  return text;
}

std::string tracePlot(const Trace& trace) {
  constexpr double width = 900, height = 230;
  const SvgBox box{70, 26, width - 90, height - 66};
  Extent values, times;
  for (const auto* one : {&trace.measured, &trace.before, &trace.after}) values.add(*one);
  times.add(trace.time_s);
  const Axis time_axis(times, box.left, box.right(), 8, false), value_axis(values, box.bottom(), box.top, 5, true);
  Svg svg(width, height, trace.signal);
  for (const double tick : value_axis.ticks()) {
    svg.line({box.left, value_axis.pixel(tick)}, {box.right(), value_axis.pixel(tick)}, "#e5e5e5", 1);
    svg.text({box.left - 6, value_axis.pixel(tick) + 4}, value_axis.label(tick), {12, SvgAnchor::end});
  }
  for (const double tick : time_axis.ticks())
    svg.text({time_axis.pixel(tick), box.bottom() + 16}, time_axis.label(tick), {12, SvgAnchor::middle});
  svg.text({0.5 * (box.left + box.right()), height - 8}, "time, s", {12, SvgAnchor::middle});
  svg.frame(box, "#999999");
  const Color measured{0.1, 0.1, 0.1, "black"}, before{0.85, 0.35, 0.1, "orange"}, after{0.1, 0.45, 0.8, "blue"};
  auto draw = [&](const std::vector<double>& y, const Color& color, double line_width, const std::string& hint) {
    if (!y.empty()) svg.curve(curvePieces(trace.time_s, y, time_axis, value_axis, Between::straight), color, line_width, box, hint);
  };
  draw(trace.measured, measured, 2.2, "measured");
  draw(trace.before, before, 1.4, "simulated before");
  draw(trace.after, after, 1.4, "simulated after");
  double x = box.left;
  auto legend = [&](const Color& color, const std::string& words) {
    svg.sample({x, 14}, 24, color, 2.2);
    svg.text({x + 30, 18}, words, {12});
    x += 150;
  };
  legend(measured, "measured");
  legend(before, "simulated before");
  if (!trace.after.empty()) legend(after, "simulated after");
  svg.text({box.right(), 18}, trace.signal, {13, SvgAnchor::end, "#222222", true});
  return svg.document();
}

std::string signalTable(const Diagnosis& d) {
  std::string rows;
  for (const auto& [name, before] : d.before.per_signal) {
    const auto after = d.after.per_signal.find(name);
    rows += fmt::format(
        "<tr><td><code>{}</code></td><td class=number>{:.3g}</td><td class=number>{:.3g}</td><td class=number>{:.3g}</td></tr>\n", name,
        before.rmse, after == d.after.per_signal.end() ? before.rmse : after->second.rmse, before.noise_floor);
  }
  return "<div class=scroll><table><tr><th>signal</th><th class=number>RMSE before</th><th class=number>RMSE after</th><th "
         "class=number>noise floor</th></tr>\n" +
         rows + "</table></div>\n";
}

std::string howFar(const Diagnosis& d) {
  std::string text = heading("How far") + paragraph("Measured on " + d.held_out + ".");
  if (!d.chosen.empty())
    text +=
        bars("Shrink of the gap",
             {{"nominal refit", d.nominal_refit_shrink_percent, fmt::format("{:.1f} %", d.nominal_refit_shrink_percent)},
              {"sham", d.sham_shrink_percent, fmt::format("{:.1f} %", d.sham_shrink_percent)},
              {"the effect", d.shrink_percent, fmt::format("{:.1f} %", d.shrink_percent)}},
             100) +
        paragraph(fmt::format(
            "Normalised gap before {:.3g}, after {:.3g}; {:.1f} % are left. The nominal refit re-tunes the model's own numbers without any "
            "effect; the sham is a disturbance without physical meaning with as many parameters.",
            d.before.normalised, d.after.normalised, d.unexplained_percent));
  text += signalTable(d);
  for (const Trace& trace : d.traces) text += tracePlot(trace);
  return text;
}

std::string whatElse(const Diagnosis& d) {
  std::string text;
  if (!d.next_experiment.commands.empty())
    text += heading("Next experiment") + paragraph(fmt::format("To tell {} apart, play the commands in next.csv: {}.",
                                                               fmt::join(d.next_experiment.separates, ", "), d.next_experiment.why));
  if (!d.not_excited.empty())
    text += heading("Not excited") +
            paragraph(fmt::format("These recordings could not have shown: {}. They may be present.", fmt::join(d.not_excited, ", ")));
  if (!d.chosen.empty())
    text += heading("Use it") +
            "<p><code>musclesim replay NEW.csv --effects effects.json</code> and <code>musclesim --effects effects.json</code> run the "
            "model with what "
            "was found.</p>\n";
  text += heading("How it was computed") +
          paragraph(fmt::format("musclesim {}; robot {}; recordings {}; {} simulations of {:.0f} s in all, {:.0f} s on the clock.",
                                MUSCLESIM_VERSION, d.robot, fmt::join(d.recordings, ", "), d.simulation_count, d.simulated_s, d.wall_s));
  for (const std::string& note : d.notes) text += paragraph("Note: " + note + ".");
  return text;
}

}  // namespace

std::string diagnosisReport(const Diagnosis& d) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width,initial-scale=1\">"
         "<title>Diagnosis of the sim-to-real gap</title><style>" +
         std::string(style) + "</style></head><body>\n<h1>Diagnosis of the sim-to-real gap</h1>\n" +
         (d.partial ? paragraph("Interrupted: this page holds only what was known by then.") : "") + "<p class=verdict>" +
         escapedXml(verdictSentence(d)) + "</p>\n" + where(d) + which(d) + howFar(d) + whatElse(d) + "</body></html>\n";
}

}  // namespace musclesim
