#include "score.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>

#include "kind.h"
#include "look_alikes.h"
#include "musclesim/base/error.h"
#include "run.h"
#include "seal.h"
#include "sha256.h"

namespace musclesim::blind {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

void requireSame(const std::string& expected, const std::string& found, const fs::path& file, const std::string& what) {
  if (expected != found) throw BadFile(file.string(), what + ": SHA-256 is " + found + ", sealed was " + expected);
}

using Cases = std::vector<Judgement>;

void putRate(json& totals, const std::string& name, const Cases& cases, const std::function<std::optional<bool>(const Judgement&)>& hit) {
  Rate rate;
  for (const Judgement& j : cases)
    if (const auto value = hit(j)) rate.add(*value);
  if (rate.count) totals[name] = rateJson(rate);
}

std::vector<double> valuesOf(const Cases& cases, std::optional<double> Judgement::*member) {
  std::vector<double> values;
  for (const Judgement& j : cases)
    if (j.*member) values.push_back(*(j.*member));
  return values;
}

void putNumber(json& totals, const std::string& name, const std::optional<double>& value) {
  if (value) totals[name] = *value;
}

json binsJson(const std::vector<Claim>& claims) {
  json bins = json::array();
  for (const CalibrationBin& bin : calibrationBins(claims)) {
    json entry = rateJson(bin.right);
    entry["mean_probability"] = bin.mean_probability;
    bins.push_back(entry);
  }
  return bins;
}

/// Causes found, wrong effects, full sets, unknown causes; how often effects acted over their inclusion probability.
void putSets(json& totals, const Cases& cases) {
  Rate found;
  std::vector<double> wrong;
  std::vector<Claim> inclusion, complete;
  for (const Judgement& j : cases) {
    found.hits += j.set.found;
    found.count += j.set.demanded;
    wrong.push_back(j.set.wrong);
    inclusion.insert(inclusion.end(), j.set.inclusion.begin(), j.set.inclusion.end());
    if (j.set.complete) complete.push_back(*j.set.complete);
  }
  if (found.count) totals["demanded_found"] = rateJson(found);
  putNumber(totals, "wrong_effects", meanOf(wrong));
  putRate(totals, "full_set", cases, [](const Judgement& j) { return j.set.full; });
  putRate(totals, "unknown_told", cases, [](const Judgement& j) { return j.set.unknown_told; });
  putRate(totals, "unknown_claimed", cases, [](const Judgement& j) { return j.set.unknown_claimed; });
  putNumber(totals, "inclusion_calibration_error", calibrationError(inclusion));
  putNumber(totals, "complete_calibration_error", calibrationError(complete));
  totals["inclusion_reliability"] = binsJson(inclusion);
}

void putRates(json& totals, const Cases& cases) {
  const std::pair<const char*, std::optional<bool> Judgement::*> members[] = {{"top1", &Judgement::top1},
                                                                              {"top3", &Judgement::top3},
                                                                              {"acceptable", &Judgement::acceptable},
                                                                              {"acceptable3", &Judgement::acceptable3},
                                                                              {"named", &Judgement::named},
                                                                              {"spurious", &Judgement::spurious},
                                                                              {"stage", &Judgement::stage},
                                                                              {"component", &Judgement::component},
                                                                              {"covered", &Judgement::covered},
                                                                              {"open_detected", &Judgement::open_detected},
                                                                              {"false_alarm", &Judgement::false_alarm}};
  putRate(totals, "verdict", cases, [](const Judgement& j) { return j.verdict_right; });
  for (const auto& [name, member] : members) putRate(totals, name, cases, [m = member](const Judgement& j) { return j.*m; });
}

/// Rates of gap reduction, known causes: at least 80 %; at least 80 % of that by the true effects; at least 20 points above the nominal
/// refit if the gap is at least three times the noise. A nominal refit that increases the gap counts as 0.
void putReduction(json& totals, const Cases& cases) {
  constexpr double enough_percent = 80, enough_share = 0.8, enough_points = 20, large_gap = 3;
  putRate(totals, "shrink_at_least_80_percent", cases,
          [](const Judgement& j) { return j.reduction_percent ? std::optional(*j.reduction_percent >= enough_percent) : std::nullopt; });
  putRate(totals, "shrink_at_least_80_percent_of_true_effect", cases,
          [](const Judgement& j) { return j.oracle_share ? std::optional(*j.oracle_share >= enough_share) : std::nullopt; });
  putRate(totals, "true_effect_listed", cases,
          [](const Judgement& j) { return j.kind == "single" && j.oracle_share ? std::optional(j.oracle_listed) : std::nullopt; });
  putRate(totals, "shrink_20_points_above_nominal_refit", cases, [](const Judgement& j) {
    if (!j.reduction_percent || j.gap_over_noise < large_gap) return std::optional<bool>();
    return std::optional(*j.reduction_percent >= std::max(0.0, *j.nominal_refit_percent) + enough_points);
  });
  putNumber(totals, "shrink_median_percent", medianOf(valuesOf(cases, &Judgement::reduction_percent)));
}

std::vector<Claim> claimsOf(const Cases& cases, const std::function<bool(const Judgement&)>& counts) {
  std::vector<Claim> claims;
  for (const Judgement& j : cases)
    if (j.claim && counts(j)) claims.push_back(*j.claim);
  return claims;
}

json grouped(const Cases& cases, const std::function<std::string(const Judgement&)>& nameOf) {
  std::map<std::string, Cases> groups;
  for (const Judgement& j : cases) groups[nameOf(j)].push_back(j);
  json totals = json::object();
  for (const auto& [name, group] : groups) totals[name] = totalsOf(group);
  return totals;
}

std::string causesOf(const Judgement& j) {
  return j.true_ids.empty() ? "none" : fmt::format("{}", fmt::join(j.true_ids, " + "));
}

/// Counts by true id and answered id, of single and open cases.
json confusionOf(const Cases& cases) {
  json confusion = json::object();
  for (const Judgement& j : cases) {
    if (j.kind != "single" && j.kind != "open") continue;
    const std::string given = j.verdict == "no_gap" || j.verdict == "failed" ? j.verdict : j.namesEffect() ? idOf(j.top) : "none_of_these";
    json& cell = confusion[j.true_ids.front()][given];
    cell = cell.is_null() ? 1 : cell.get<int>() + 1;
  }
  return confusion;
}

template <class Value>
void put(json& object, const char* name, const std::optional<Value>& value) {
  if (value) object[name] = *value;
}

json caseJson(const Judgement& j) {
  json object = {{"robot", j.robot},
                 {"kind", j.kind},
                 {"size", j.size},
                 {"truth", j.truth},
                 {"gap_over_noise", j.gap_over_noise},
                 {"verdict", j.verdict},
                 {"verdict_right", j.verdict_right},
                 {"top", j.top},
                 {"top_probability", j.top_probability},
                 {"none_of_these", j.none_of_these},
                 {"demanded", j.set.demanded},
                 {"found", j.set.found},
                 {"wrong", j.set.wrong},
                 {"seconds", j.seconds}};
  put(object, "acceptable", j.acceptable);
  put(object, "acceptable3", j.acceptable3);
  put(object, "stage", j.stage);
  put(object, "covered", j.covered);
  put(object, "full_set", j.set.full);
  put(object, "unknown_told", j.set.unknown_told);
  put(object, "open_detected", j.open_detected);
  put(object, "false_alarm", j.false_alarm);
  put(object, "probability_of_truth", j.probability_of_truth);
  put(object, "shrink_percent", j.reduction_percent);
  put(object, "oracle_share", j.oracle_share);
  put(object, "spurious", j.spurious);
  if (!j.message.empty()) object["message"] = j.message;
  return object;
}

}  // namespace

std::vector<Claim> claimsOfOneCause(const Cases& cases) {
  return claimsOf(cases, [](const Judgement& j) { return j.kind == "single" || j.kind == "open"; });
}

json totalsOf(const Cases& cases) {
  json totals = {{"cases", cases.size()}};
  putRates(totals, cases);
  putReduction(totals, cases);
  putSets(totals, cases);
  putNumber(totals, "probability_of_truth", meanOf(valuesOf(cases, &Judgement::probability_of_truth)));
  putNumber(totals, "probability_of_acceptable", meanOf(valuesOf(cases, &Judgement::probability_of_acceptable)));
  putNumber(totals, "set_size", meanOf(valuesOf(cases, &Judgement::set_size)));
  putNumber(totals, "calibration_error", calibrationError(claimsOfOneCause(cases)));
  if (const auto chance = calibrationErrorByChance(claimsOfOneCause(cases)))
    totals["calibration_error_by_chance"] = {{"mean", chance->mean}, {"high", chance->high}};
  putNumber(totals, "calibration_error_all_kinds", calibrationError(claimsOf(cases, [](const Judgement&) { return true; })));
  std::vector<double> seconds;
  for (const Judgement& j : cases) seconds.push_back(j.seconds);
  putNumber(totals, "seconds_median", medianOf(seconds));
  return totals;
}

Score score(const fs::path& folder, const fs::path& key_file) {
  Score result{readSeal(folder), readObject(folder / "answers.json"), {}, {}, {}};
  requireSame(result.seal["key_sha256"], sha256OfFile(key_file), key_file, "the key was changed or is another one");
  requireSame(result.seal["recordings_sha256"], sha256OfFiles(folder, recordingFiles(folder)), folder, "recordings were changed");
  requireSame(result.answers.value("answers_sha256", ""), sha256OfFiles(folder, answerFiles(folder)), folder / "answers",
              "answers were changed");
  const json key = readObject(key_file);
  for (const auto& [name, case_key] : key.at("cases").items()) {
    result.cases.push_back(judge(name, case_key, readObject(folder / "answers" / (name + ".json"))));
    result.cases.back().seconds = result.answers.at("seconds").value(name, 0.0);
  }
  result.follow_ups = followUpsOf(folder, key.at("cases"));
  Cases several;
  std::ranges::copy_if(result.cases, std::back_inserter(several), [](const Judgement& j) { return kindOf(j.kind).isSeveral(); });
  result.totals = {{"all", totalsOf(result.cases)},
                   {"several", totalsOf(several)},
                   {"by_kind", grouped(result.cases, [](const Judgement& j) { return j.kind; })},
                   {"by_robot", grouped(result.cases, [](const Judgement& j) { return j.robot; })},
                   {"by_size", grouped(result.cases, [](const Judgement& j) { return j.size; })},
                   {"by_effect", grouped(result.cases, causesOf)},
                   {"confusion", confusionOf(result.cases)},
                   {"reliability", binsJson(claimsOfOneCause(result.cases))},
                   {"follow_up", followUpTotals(result.follow_ups)}};
  return result;
}

json scoreJson(const Score& score) {
  json object = score.totals;
  object["format"] = "musclesim-blind-score-1";
  object["seal"] = score.seal;
  for (const Judgement& j : score.cases) object["cases"][j.name] = caseJson(j);
  return object;
}

}  // namespace musclesim::blind
