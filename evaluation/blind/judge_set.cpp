#include "judge_set.h"

#include <algorithm>
#include <string>

#include "kind.h"
#include "look_alikes.h"

namespace musclesim::blind {

using nlohmann::json;

namespace {

using Labels = std::vector<std::string>;

/// A known cause: the answers that fit it.
struct KnownCause {
  Labels patterns;
  bool demanded;
};

std::vector<KnownCause> knownCausesIn(const json& key) {
  std::vector<KnownCause> causes;
  const json& effects = key.at("effects");
  json acceptable = key.at("acceptable");
  if (!acceptable.empty() && acceptable.front().is_string()) acceptable = json::array({acceptable});  // of the only cause
  for (std::size_t i = 0; i < acceptable.size(); ++i)
    causes.push_back({acceptable[i].get<Labels>(), effects.at(i).value("demanded", true)});
  return causes;
}

bool isNamed(const KnownCause& cause, const Labels& labels) {
  return std::ranges::any_of(labels, [&](const std::string& label) { return fitsAny(label, cause.patterns); });
}

bool fitsOne(const std::string& label, const std::vector<KnownCause>& causes) {
  return std::ranges::any_of(causes, [&](const KnownCause& cause) { return fitsAny(label, cause.patterns); });
}

bool isFull(const std::vector<KnownCause>& causes, const Labels& set) {
  return std::ranges::all_of(causes, [&](const KnownCause& cause) { return !cause.demanded || isNamed(cause, set); }) &&
         std::ranges::all_of(set, [&](const std::string& label) { return fitsOne(label, causes); });
}

std::vector<Labels> ambiguitySets(const json& answer) {
  std::vector<Labels> sets;
  if (answer.contains("ambiguity_sets")) return answer["ambiguity_sets"].get<std::vector<Labels>>();
  for (const std::string& label : answer.value("ambiguity_set", Labels())) sets.push_back({label});
  return sets;
}

/// What the answer says of sets.
void judgeClaims(SetJudgement& j, const std::vector<KnownCause>& causes, const Labels& chosen, const json& answer) {
  const auto full = [&](const Labels& set) { return isFull(causes, set); };
  j.full = full(chosen);
  j.probability = 0;
  for (const json& explanation : answer.value("explanations", json::array()))
    if (full(explanation.at("effects").get<Labels>())) *j.probability += explanation.at("probability").get<double>();
  const std::vector<Labels> sets = ambiguitySets(answer);
  j.covered = *j.full || std::ranges::any_of(sets, full);
  j.class_size = std::max<double>(1, static_cast<double>(sets.size()));
}

std::vector<Claim> inclusionClaims(const std::vector<KnownCause>& causes, const json& answer) {
  std::vector<Claim> claims;
  std::vector<double> sums(causes.size(), 0);
  for (const json& effect : answer.value("effects", json::array())) {
    const std::string label = effect.value("id", "") + "@" + effect.value("component", "all");
    const auto cause = std::ranges::find_if(causes, [&](const KnownCause& one) { return fitsAny(label, one.patterns); });
    const double probability = effect.value("probability", 0.0);
    if (cause == causes.end())
      claims.push_back({probability, false});
    else
      sums[static_cast<std::size_t>(cause - causes.begin())] += probability;
  }
  for (std::size_t i = 0; i < causes.size(); ++i)
    if (causes[i].demanded) claims.push_back({std::min(1.0, sums[i]), true});
  return claims;
}

/// Whether an unknown cause acts; empty if one does that is too small to be told.
std::optional<bool> unknownActs(const json& key) {
  if (!kindOf(key.at("kind")).unknown) return false;
  const json& unknown = key.at("effects").back();
  return unknown.value("demanded", true) ? std::optional(true) : std::nullopt;
}

void judgeRemainder(SetJudgement& j, const json& key, const json& answer) {
  const json remainder = answer.value("remainder", json::object());
  const bool said = answer.value("verdict", "") == "unexplained" || remainder.value("significant", false);
  const auto acts = unknownActs(key);
  if (!acts) return;
  (*acts ? j.unknown_told : j.unknown_claimed) = said;
  if (remainder.contains("probability")) j.complete = Claim{1 - remainder["probability"].get<double>(), !*acts};
}

}  // namespace

SetJudgement judgeSet(const json& key, const json& answer) {
  SetJudgement j;
  const std::vector<KnownCause> causes = knownCausesIn(key);
  const Labels chosen = answer.value("chosen", Labels());
  for (const KnownCause& cause : causes) {
    j.demanded += cause.demanded ? 1 : 0;
    j.found += cause.demanded && isNamed(cause, chosen) ? 1 : 0;
  }
  j.wrong = static_cast<int>(std::ranges::count_if(chosen, [&](const std::string& label) { return !fitsOne(label, causes); }));
  if (j.demanded > 0) judgeClaims(j, causes, chosen, answer);
  judgeRemainder(j, key, answer);
  if (answer.value("verdict", "") != "failed") j.inclusion = inclusionClaims(causes, answer);
  return j;
}

bool isWholeTruth(const json& key, const std::vector<std::string>& effects) {
  const std::string kind = key.value("kind", "");
  return kind != "open" && kind != "mixed" && isFull(knownCausesIn(key), effects);
}

}  // namespace musclesim::blind
