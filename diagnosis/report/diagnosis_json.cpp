// diagnosis.json, format musclesim-diagnosis-1, and the summary for the terminal.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "../words/fitted_numbers.h"
#include "../words/sentences.h"
#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

namespace {

using Json = nlohmann::ordered_json;

Json toJson(double value) {
  if (std::isfinite(value)) return value;
  if (std::isnan(value)) return nullptr;
  return value > 0 ? "inf" : "-inf";
}

Json toJson(const Gap& gap) {
  Json signals = Json::object();
  for (const auto& [name, signal] : gap.per_signal)
    signals[name] = {{"rmse", signal.rmse}, {"noise_floor", signal.noise_sigma}, {"motion", signal.motion}};
  return {{"normalised", gap.normalised}, {"per_signal", signals}};
}

Json toJson(const FoundEffect& effect) {
  Json parameters = Json::object();
  for (const auto& [name, estimate] : effect.parameters) {
    parameters[name] = {{"value", toJson(estimate.value)}};
    if (estimate.is_determined)
      parameters[name]["ci95"] = {toJson(estimate.low), toJson(estimate.high)};
    else
      parameters[name]["determined"] = false;
  }
  Json json = {{"id", effect.id}, {"component", effect.component}, {"probability", effect.probability}, {"parameters", parameters}};
  if (effect.reduction_percent) json["shrink_percent"] = *effect.reduction_percent;
  if (effect.removes_percent) json["removes_percent"] = *effect.removes_percent;
  if (!effect.choices.empty()) json["choices"] = effect.choices;
  return json;
}

/// What the signals show is where most of the gap arises; a cause that was found elsewhere makes the rest.
Json toJson(const Place& place, bool is_found) {
  Json json = {{"stage", place.stage}, {"component", place.component}, {"share", place.share}};
  json["ruled_out"] = place.is_ruled_out && !is_found;
  if (is_found) json["found"] = true;
  if (!place.phase.empty()) json["regime"] = place.phase;
  return json;
}

Json toJson(const TunedParameter& parameter) {
  return {{"name", parameter.name},
          {"unit", parameter.unit},
          {"start", parameter.start},
          {"value", parameter.fitted.value},
          {"ci95", {toJson(parameter.fitted.low), toJson(parameter.fitted.high)}},
          {"value_with_effects", parameter.with_effects.value},
          {"ci95_with_effects", {toJson(parameter.with_effects.low), toJson(parameter.with_effects.high)}},
          {"determined", parameter.with_effects.is_determined}};
}

/// An interval of a reduction that says anything; one that reaches far below 0 does not.
void addInterval(Json& json, double low, double high) {
  constexpr double least_percent = -100;
  if (low >= least_percent) json["shrink_ci95_percent"] = {low, high};
}

Json gapJson(const Diagnosis& d) {
  Json json = {{"before", toJson(d.before)},
               {"after", toJson(d.after)},
               {"shrink_percent", d.reduction_percent},
               {"held_out", true},
               {"nominal_refit_shrink_percent", d.nominal_refit_percent},
               {"sham_shrink_percent", d.negative_control_percent}};
  addInterval(json, d.reduction_low_percent, d.reduction_high_percent);
  if (d.small_gap) json["small"] = {{"signal", d.small_gap->signal}, {"percent_of_motion", d.small_gap->percent_of_motion}};
  return json;
}

Json toJson(const Remainder& remainder) {
  Json json = {{"significant", remainder.is_significant},
               {"within_step_error", remainder.is_within_steps},
               {"stage", remainder.stage},
               {"signal", remainder.signal},
               {"in_noise_floors", remainder.in_sigmas},
               {"percent_of_gap", remainder.percent_of_gap},
               {"probability", remainder.probability}};
  if (!remainder.shape.empty()) json["shape"] = remainder.shape;
  return json;
}

Json toJson(const FittedNumber& number) {
  return {{"name", number.name},
          {"unit", number.unit},
          {"start", number.start},
          {"value", number.fitted.value},
          {"ci95", {toJson(number.fitted.low), toJson(number.fitted.high)}},
          {"in_tolerances", number.in_tolerances}};
}

Json toJson(const NumberInstead& number) {
  return {{"name", number.name}, {"unit", number.unit}, {"given", number.given}, {"instead", number.instead}, {"effects", number.effects}};
}

template <class Value>
Json listOf(const std::vector<Value>& values) {
  Json list = Json::array();
  for (const Value& value : values) list.push_back(toJson(value));
  return list;
}

/// The explanations that were fitted, and what they are weighed by: enough to weigh them anew without simulating.
Json fittedJson(const Diagnosis& d) {
  Json json = {{"looks", Json::array()}, {"cells", Json::array()}, {"trials", Json::array()}};
  for (const Screening& screening : d.screenings) json["looks"].push_back({screening.effect, screening.removed});
  for (const FittedBlock& block : d.blocks)
    json["cells"].push_back({{"recording", block.recording},
                             {"signal", block.signal},
                             {"floor", block.sigma},
                             {"rms_before", block.rms_before},
                             {"averaged_rows", block.averaged_rows},
                             {"parity", block.is_parity}});
  for (const Trial& trial : d.trials)
    json["trials"].push_back({{"effects", trial.effects},
                              {"parameters", trial.parameter_count},
                              {"rms", trial.rms},
                              {"misfits", trial.misfits},
                              {"complexity", trial.complexity},
                              {"numbers_cost", trial.numbers_cost},
                              {"score", trial.score},
                              {"values", trial.values}});
  return json;
}

}  // namespace

std::string diagnosisJson(const Diagnosis& d, const std::string& schedule_file) {
  Json json = {{"format", "musclesim-diagnosis-1"}, {"robot", d.robot}, {"recordings", d.recordings}, {"verdict", nameOf(d.verdict)}};
  json["where"] = Json::array();
  for (const Place& place : d.where) json["where"].push_back(toJson(place, isFoundAt(d, place.stage)));
  json["effects"] = listOf(d.effects);
  json["none_of_these"] = d.none_of_these;
  json["explanations"] = Json::array();
  for (const ExplanationProbability& fitted : d.explanations)
    json["explanations"].push_back({{"effects", fitted.effects}, {"probability", fitted.probability}});
  if (!d.candidates.empty()) json["candidates"] = d.candidates;
  json["chosen"] = d.chosen;
  json["ambiguity_set"] = d.ambiguity_set;
  json["ambiguity_sets"] = d.ambiguity_sets;
  json["gap"] = gapJson(d);
  if (!d.attempt.effects.empty()) {
    json["attempt"] = {{"effects", d.attempt.effects}, {"after", toJson(d.attempt.after)}, {"shrink_percent", d.attempt.reduction_percent}};
    addInterval(json["attempt"], d.attempt.reduction_low_percent, d.attempt.reduction_high_percent);
  }
  if (d.remainder.in_sigmas > 0) json["remainder"] = toJson(d.remainder);
  if (!d.numbers.empty()) json["numbers"] = listOf(d.numbers);
  if (!d.numbers_instead.empty()) json["numbers_instead"] = listOf(d.numbers_instead);
  if (!d.tuned.empty()) json["tuned"] = listOf(d.tuned);
  if (!d.odd_recordings.empty()) json["odd_recordings"] = d.odd_recordings;
  if (!d.unknown_start.empty()) json["unknown_start"] = d.unknown_start;
  if (!d.muscle_names.empty()) json["muscle_names"] = d.muscle_names;
  if (d.substeps > 0) json["substeps"] = d.substeps;
  json["unexplained_percent"] = d.unexplained_percent;
  json["not_excited"] = d.not_excited;
  if (!d.next_experiment.commands.empty())
    json["next_experiment"] = {
        {"separates", d.next_experiment.separates}, {"name", d.next_experiment.schedule}, {"amplitude", d.next_experiment.amplitude},
        {"level", d.next_experiment.level},         {"why", d.next_experiment.why},       {"schedule", schedule_file}};
  json["fitted"] = fittedJson(d);
  if (!d.model_effects.empty()) json["model_effects"] = d.model_effects;
  json["notes"] = d.notes;
  if (!d.unsteady.signal.empty())
    json["unsteady"] = {{"signal", d.unsteady.signal},
                        {"in_noise_floors", d.unsteady.in_sigmas},
                        {"share_of_gap", d.unsteady.share_of_gap},
                        {"by", d.unsteady.by == Unsteady::Change::steps ? "longer_steps" : "stronger_muscles"}};
  json["where_method"] = d.where_method;
  json["partial"] = d.partial;
  json["cost"] = {{"simulated_s", d.simulated_s}, {"wall_s", d.wall_s}, {"simulations", d.simulation_count}};
  return json.dump(1) + "\n";
}

namespace {

std::string numberLines(const Diagnosis& d) {
  std::string text;
  for (const FittedNumber& number : d.numbers)
    text += fmt::format("{:<9} {} = {} {}, given as {:.4g}\n", &number == &d.numbers.front() ? "numbers" : "", number.name,
                        estimateWords(number.fitted), number.unit, number.start);
  return text + "          nominal.toml holds them, for --config\n";
}

/// Where, which effects, and which sets of them.
std::string causeLines(const Diagnosis& d) {
  constexpr double worth_listing = 0.1;   ///< probability of an effect that is not in the chosen set
  constexpr std::size_t most_listed = 6;  ///< lines of effects, and of sets
  std::string text;
  if (!d.where.empty()) text += fmt::format("where     {}\n", whereSentence(d));
  const auto listed = [&](const char* title, double probability, const std::string& words) {
    text += fmt::format("{:<9} {:>11}  {}\n", title, probabilityWords(probability), words);
  };
  std::size_t count = 0;
  for (const FoundEffect& effect : d.effects) {
    const bool is_chosen = std::ranges::find(d.chosen, effect.label()) != d.chosen.end();
    if (is_chosen || (effect.probability >= worth_listing && count < most_listed) || count == 0)
      listed(count++ == 0 ? "which" : "", effect.probability, effectSentence(effect));
  }
  if (d.none_of_these > 0) listed("", d.none_of_these, "none of these");
  if (d.ambiguity_sets.size() > 1)
    for (std::size_t i = 0; i < std::min(most_listed, d.ambiguity_sets.size()); ++i) {
      const auto set = std::ranges::find_if(
          d.explanations, [&](const ExplanationProbability& one) { return std::ranges::is_permutation(one.effects, d.ambiguity_sets[i]); });
      listed(i == 0 ? "sets" : "", set == d.explanations.end() ? 0 : set->probability,
             fmt::format("{}", fmt::join(d.ambiguity_sets[i], " + ")));
    }
  return text;
}

}  // namespace

std::string diagnosisSummary(const Diagnosis& d) {
  std::string text = verdictSentence(d) + "\n";
  if (d.partial) text = "Interrupted: these are only the results up to the interruption.\n" + text;
  if (!d.muscle_names.empty()) text += fmt::format("muscles   {}\n", muscleNameWords(d));
  if (!d.tuned.empty()) text += fmt::format("tuned     {} of the model first, see nominal.toml\n", counted(d.tuned.size(), "parameter"));
  text += isExplainedByNumbers(d) ? numberLines(d) : causeLines(d);
  if (!d.chosen.empty())
    text += fmt::format("how far   {} of the gap on {}; nominal refit {:.1f} %, negative control {:.1f} %\n          {}\n",
                        percentWords(d.reduction_percent), d.held_out, d.nominal_refit_percent, d.negative_control_percent,
                        elsewhereSentence({d.reduction_percent, d.reduction_low_percent, d.reduction_high_percent}));
  for (const std::string& odd : d.odd_recordings) text += fmt::format("but       {}\n", odd);
  if (!d.unknown_start.empty()) text += fmt::format("start     {}\n", d.unknown_start);
  if (!d.next_experiment.commands.empty()) text += fmt::format("next      record next.csv, {}\n", d.next_experiment.why);
  return text;
}

}  // namespace musclesim
