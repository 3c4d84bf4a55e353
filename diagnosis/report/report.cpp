// report.html: one page, self-contained. This file puts its parts together and holds the last ones.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "../../base/short_names.h"
#include "../../log/svg.h"
#include "../words/effect_words.h"
#include "../words/sentences.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/version.h"
#include "report_figures.h"
#include "report_page.h"
#include "report_parts.h"
#include "report_shared.h"

namespace musclesim::report {

namespace {

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
         (fittedNumbersToml(d).empty() ? "" : " and with the numbers of the model that were fitted together with them (nominal.toml)") +
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
  return fmt::format("Robot {}; recordings {}.{}", std::filesystem::path(d.robot).filename().string(),
                     fmt::join(shortNames(d.recordings), ", "), d.muscle_names.empty() ? "" : " Muscles: " + muscleNameWords(d) + ".");
}

std::string foot(const Diagnosis& d, const ReportOrigin& origin) {
  std::string text = "<footer><p>musclesim " MUSCLESIM_VERSION;
  if (!origin.date.empty()) text += ", " + escapedXml(origin.date);
  text += fmt::format(". Recordings: {}.</p>\n", escapedXml(fmt::format("{}", fmt::join(d.recordings, ", "))));
  if (!origin.command_line.empty()) text += "<p><code>" + escapedXml(origin.command_line) + "</code></p>\n";
  return text + "</footer>\n";
}

}  // namespace

}  // namespace musclesim::report

namespace musclesim {

std::string diagnosisReport(const Diagnosis& d, const ReportOrigin& origin) {
  using namespace report;
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width,initial-scale=1\"><title>Diagnosis of the sim-to-real gap</title><style>" +
         reportStyle() + "</style></head><body>\n<h1><b>Diagnosis of the sim-to-real gap.</b> " + escapedXml(subject(d)) + "</h1>\n" +
         (d.partial ? paragraph("Interrupted: this page holds only the results up to the interruption.") : "") + verdictBox(d) + where(d) +
         which(d) + howFar(d) + curves(d) + loops(d) + tuned(d) + whatElse(d) + foot(d, origin) + glossary() + reportScript() +
         "</body></html>\n";
}

}  // namespace musclesim
