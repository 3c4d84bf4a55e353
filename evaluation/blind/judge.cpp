#include "judge.h"

#include <algorithm>
#include <cmath>

#include "look_alikes.h"

namespace musclesim::blind {

using nlohmann::json;

namespace {

/// A candidate of an answer.
struct Answer {
  std::string label;
  double probability = 0, reduction_percent = 0;
};

std::vector<Answer> candidatesOf(const json& answer) {
  std::vector<Answer> candidates;
  for (const json& effect : answer.value("effects", json::array()))
    candidates.push_back({effect.value("id", "") + "@" + effect.value("component", "all"), effect.value("probability", 0.0),
                          effect.value("shrink_percent", 0.0)});
  std::ranges::stable_sort(candidates, std::greater<>(), &Answer::probability);
  return candidates;
}

using Patterns = std::vector<std::vector<std::string>>;

std::vector<std::string> flat(const Patterns& sets) {
  std::vector<std::string> all;
  for (const auto& set : sets) all.insert(all.end(), set.begin(), set.end());
  return all;
}

double probabilityOf(const std::vector<Answer>& candidates, const std::vector<std::string>& patterns) {
  double sum = 0;
  for (const Answer& candidate : candidates)
    if (fitsAny(candidate.label, patterns)) sum += candidate.probability;
  return std::min(sum, 1.0);
}

void judgeRanking(Judgement& j, const std::vector<Answer>& candidates, const Patterns& acceptable, const std::vector<std::string>& truth) {
  constexpr std::size_t listed = 3;
  const std::vector<std::string> accepted = flat(acceptable);
  auto names = [&](const Answer& a) { return std::ranges::find(j.true_ids, idOf(a.label)) != j.true_ids.end(); };
  auto fitsAccepted = [&](const Answer& a) { return fitsAny(a.label, accepted); };
  const std::vector<Answer> first(candidates.begin(),
                                  candidates.begin() + static_cast<std::ptrdiff_t>(std::min(listed, candidates.size())));
  j.top1 = !first.empty() && names(first.front());
  j.top3 = std::ranges::any_of(first, names);
  j.acceptable = j.namesEffect() && !first.empty() && fitsAccepted(first.front());
  j.acceptable3 = std::ranges::any_of(first, fitsAccepted);
  if (*j.top1) j.component = fitsAny(first.front().label, truth);
  if (j.kind == "single") {
    j.named = j.component.value_or(false) && j.namesEffect();
    j.probability_of_truth = probabilityOf(candidates, truth);
  }
  j.probability_of_acceptable = probabilityOf(candidates, accepted);
}

void judgeReduction(Judgement& j, const json& key, const json& answer, const std::vector<Answer>& candidates,
                    const std::vector<std::string>& truth) {
  const json gap = answer.value("gap", json::object());
  j.reduction_percent = gap.value("shrink_percent", 0.0);
  j.nominal_refit_percent = gap.value("nominal_refit_shrink_percent", 0.0);
  constexpr double everything_percent = 100, least_percent = 20;
  double oracle_percent = key.value("oracle_shrink_percent", everything_percent);
  const auto listed = std::ranges::find_if(
      candidates, [&](const Answer& candidate) { return fitsAny(candidate.label, truth) && candidate.reduction_percent > 0; });
  j.oracle_listed = j.kind == "single" && listed != candidates.end();
  if (j.oracle_listed) oracle_percent = listed->reduction_percent;
  if (oracle_percent >= least_percent || j.oracle_listed) j.oracle_share = *j.reduction_percent / oracle_percent;
}

/// The ambiguity set of a lone cause.
void judgeAmbiguity(Judgement& j, const json& answer, const std::vector<std::string>& truth) {
  std::vector<std::string> named = answer.value("chosen", std::vector<std::string>());
  named.insert(named.end(), j.ambiguity_set.begin(), j.ambiguity_set.end());
  j.set_size = std::max<double>(1, static_cast<double>(j.ambiguity_set.size()));
  j.covered = std::ranges::any_of(named, [&](const std::string& label) { return fitsAny(label, truth); });
}

/// The truth under all names of its component: the acceptable answers with the same id.
Patterns truthsOf(const std::vector<std::string>& ids, const Patterns& acceptable) {
  Patterns truths;
  for (std::size_t i = 0; i < acceptable.size(); ++i) {
    truths.emplace_back();
    std::ranges::copy_if(acceptable[i], std::back_inserter(truths.back()), [&](const std::string& p) { return idOf(p) == ids[i]; });
  }
  return truths;
}

/// The most probable claim of an answer; empty if there is no answer.
std::optional<Claim> claimOf(const Judgement& j, bool right) {
  if (j.verdict == "failed") return std::nullopt;
  return Claim{j.confidence(), right};
}

void judgeFound(Judgement& j, const json& key, const json& answer, const std::vector<Answer>& candidates) {
  const auto acceptable = key.at("acceptable").get<Patterns>();
  const Patterns truths = truthsOf(j.true_ids, acceptable);
  judgeRanking(j, candidates, acceptable, flat(truths));
  judgeReduction(j, key, answer, candidates, flat(truths));
  j.spurious = j.set.wrong > 0;
  if (j.kind == "single") {
    judgeAmbiguity(j, answer, flat(truths));
  } else {
    j.covered = j.set.covered;
    j.set_size = j.set.class_size;
    j.probability_of_truth = j.set.probability;
  }
  j.claim = claimOf(j, *j.acceptable);
}

void judgeOpen(Judgement& j) {
  constexpr double confident = 0.5;
  j.open_detected = j.verdict == "unexplained" || (j.verdict == "effects_found" && j.top_probability <= confident);
  j.claim = claimOf(j, j.none_of_these >= j.confidence());
}

Judgement head(const std::string& name, const json& key) {
  Judgement j;
  j.name = name;
  j.robot = key.at("robot");
  j.kind = key.at("kind");
  j.size = key.at("size");
  j.gap_over_noise = key.at("gap_over_noise");
  j.true_stages = key.at("stages").get<std::vector<std::string>>();
  for (const json& effect : key.at("effects")) {
    j.true_ids.push_back(effect.at("id"));
    j.truth += (j.truth.empty() ? "" : " + ") + j.true_ids.back() + "@" + effect.at("component").get<std::string>();
  }
  return j;
}

}  // namespace

double Judgement::confidence() const {
  return std::max({top_probability, none_of_these, no_effect});
}

Judgement judge(const std::string& name, const json& key, const json& answer) {
  Judgement j = head(name, key);
  j.verdict = answer.value("verdict", "");
  j.message = answer.value("message", "");
  j.verdict_right = j.verdict == key.at("verdict");
  const std::vector<Answer> candidates = candidatesOf(answer);
  if (!candidates.empty()) {
    j.top = candidates.front().label;
    j.top_probability = candidates.front().probability;
  }
  j.none_of_these = answer.value("none_of_these", 0.0);
  for (const json& explanation : answer.value("explanations", json::array()))
    if (explanation.at("effects").empty()) j.no_effect = explanation.at("probability");
  j.ambiguity_set = answer.value("ambiguity_set", std::vector<std::string>());
  j.set = judgeSet(key, answer);
  if (j.kind == "null") {
    const bool corrects_numbers = j.verdict == "effects_found" && answer.contains("chosen") && answer["chosen"].empty();
    j.verdict_right = j.verdict_right || corrects_numbers;
    j.false_alarm = j.verdict != "no_gap" && j.verdict != "not_excited" && !corrects_numbers;
    j.claim = claimOf(j, j.no_effect >= j.confidence());
    return j;
  }
  const json where = answer.value("where", json::array());
  const std::string stage = where.empty() ? "" : where.front().value("stage", "");
  j.stage = std::ranges::find(j.true_stages, stage) != j.true_stages.end();
  if (j.kind == "open")
    judgeOpen(j);
  else if (j.set.demanded > 0)
    judgeFound(j, key, answer, candidates);
  return j;
}

bool namesTruth(const Judgement& answer) {
  return answer.verdict == "effects_found" && answer.named.value_or(false);
}

bool isAmbiguous(const Judgement& answer) {
  return answer.kind == "single" && answer.set_size.value_or(1) > 1 && answer.namesEffect();
}

}  // namespace musclesim::blind
