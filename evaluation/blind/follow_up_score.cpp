#include "follow_up_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "follow_up_files.h"
#include "look_alikes.h"
#include "seal.h"

namespace musclesim::blind {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr double confident_probability = 0.9, wide_points = 20;

FreshReduction freshOf(const json& object) {
  FreshReduction fresh{object.at("shrink_percent"), object.at("reported_percent"), {}, object.at("diverged")};
  if (object.contains("interval_percent")) fresh.interval_percent = object["interval_percent"].get<std::pair<double, double>>();
  return fresh;
}

FollowUp followUpOf(const fs::path& folder, const std::string& name, const json& key) {
  const json noted = readObject(followUpFile(folder, name));
  FollowUp result{judge(name, key, readObject(folder / "answers" / (name + ".json"))), {}, {}, {}};
  if (noted.contains("left_out")) result.left_out = judge(name, key, noted["left_out"]);
  if (noted.contains("experiment")) result.experiment = judge(name, key, noted["experiment"]);
  if (noted.contains("fresh")) result.fresh = freshOf(noted["fresh"]);
  return result;
}

/// Adds a rate over the follow-ups for which `hit` has a value.
void putRate(json& totals, const std::string& name, const std::vector<FollowUp>& follow_ups,
             const std::function<std::optional<bool>(const FollowUp&)>& hit) {
  Rate rate;
  for (const FollowUp& one : follow_ups)
    if (const auto value = hit(one)) rate.add(*value);
  if (rate.count) totals[name] = rateJson(rate);
}

void putLeftOut(json& totals, const std::vector<FollowUp>& follow_ups) {
  for (const auto& [name, what] :
       {std::pair("left_out_failed", WithoutTruth::failed), std::pair("left_out_confidently_wrong", WithoutTruth::confidently_wrong),
        std::pair("left_out_look_alike", WithoutTruth::look_alike), std::pair("left_out_named_before", WithoutTruth::named_before),
        std::pair("left_out_class_mate", WithoutTruth::class_mate), std::pair("left_out_unexplained", WithoutTruth::unexplained),
        std::pair("left_out_unsure", WithoutTruth::unsure)})
    putRate(totals, name, follow_ups, [what = what](const FollowUp& one) {
      return one.left_out ? std::optional(withoutTruth(*one.left_out, one.answer) == what) : std::nullopt;
    });
}

void putExperiment(json& totals, const std::vector<FollowUp>& follow_ups) {
  auto put = [&](const char* name, bool (*counts)(const Judgement& before), bool (*hit)(const FollowUp&)) {
    putRate(totals, name, follow_ups,
            [&](const FollowUp& one) { return one.experiment && counts(one.answer) ? std::optional(hit(one)) : std::nullopt; });
  };
  auto any = [](const Judgement&) { return true; };
  auto after = [](const FollowUp& one) { return namesTruth(*one.experiment); };
  put("experiment_truth_first_before", any, [](const FollowUp& one) { return namesTruth(one.answer); });
  put("experiment_truth_first", any, after);
  put(
      "experiment_truth_first_where_covered", [](const Judgement& before) { return before.covered.value_or(false); }, after);
  put("experiment_alone", any, [](const FollowUp& one) { return namesTruth(*one.experiment) && one.experiment->set_size == 1; });
}

void putFresh(json& totals, const std::vector<FollowUp>& follow_ups) {
  auto put = [&](const char* name, bool (*counts)(const FreshReduction&), bool (*hit)(const FreshReduction&)) {
    putRate(totals, name, follow_ups,
            [&](const FollowUp& one) { return one.fresh && counts(*one.fresh) ? std::optional(hit(*one.fresh)) : std::nullopt; });
  };
  auto any = [](const FreshReduction& fresh) { return fresh.interval_percent.has_value(); };
  auto narrow = [](const FreshReduction& fresh) { return fresh.interval_percent && fresh.width() <= wide_points; };
  put("fresh_within", any, [](const FreshReduction& fresh) { return fresh.isWithin(); });
  put("fresh_narrow", any, [](const FreshReduction& fresh) { return fresh.width() <= wide_points; });
  put("fresh_within_narrow", narrow, [](const FreshReduction& fresh) { return fresh.isWithin(); });
  std::vector<double> difference, width;
  for (const FollowUp& one : follow_ups) {
    if (!one.fresh) continue;
    if (!one.fresh->diverged) difference.push_back(std::abs(one.fresh->reduction_percent - one.fresh->reported_percent));
    if (one.fresh->interval_percent) width.push_back(one.fresh->width());
  }
  if (const auto median = medianOf(difference)) totals["fresh_median_difference_points"] = *median;
  if (const auto median = medianOf(width)) totals["fresh_median_width_points"] = *median;
}

}  // namespace

WithoutTruth withoutTruth(const Judgement& answer, const Judgement& with_truth) {
  if (answer.verdict == "failed") return WithoutTruth::failed;
  const bool look_alike = answer.acceptable.value_or(false);
  const bool named_before =
      with_truth.covered.value_or(false) && std::ranges::find(with_truth.ambiguity_set, answer.top) != with_truth.ambiguity_set.end();
  const bool confident_effect = answer.verdict == "effects_found" && answer.top_probability > confident_probability;
  const bool class_mate =
      std::ranges::any_of(with_truth.true_ids, [&](const std::string& id) { return areOfOneClass(id, idOf(answer.top)); });
  if (confident_effect && !look_alike && !named_before) return class_mate ? WithoutTruth::class_mate : WithoutTruth::confidently_wrong;
  if (answer.verdict != "effects_found" || !answer.namesEffect()) return WithoutTruth::unexplained;
  return look_alike ? WithoutTruth::look_alike : named_before ? WithoutTruth::named_before : WithoutTruth::unsure;
}

std::vector<FollowUp> followUpsOf(const fs::path& folder, const json& cases) {
  std::vector<FollowUp> follow_ups;
  for (const auto& [name, key] : cases.items())
    if (isFollowed(folder, name)) follow_ups.push_back(followUpOf(folder, name, key));
  return follow_ups;
}

json followUpTotals(const std::vector<FollowUp>& follow_ups) {
  if (follow_ups.empty()) return json::object();
  json totals = {{"followed_count", follow_ups.size()}};
  putLeftOut(totals, follow_ups);
  putExperiment(totals, follow_ups);
  putFresh(totals, follow_ups);
  return totals;
}

std::vector<std::string> missesOf(const FollowUp& follow_up) {
  std::vector<std::string> misses;
  auto said = [](const Judgement& j) {
    return j.verdict == "failed"                       ? "failed: " + j.message
           : j.verdict == "no_gap" || !j.namesEffect() ? fmt::format("{}, none of these {:.2f}", j.verdict, j.none_of_these)
                                                       : fmt::format("{}, {} {:.2f}", j.verdict, j.top, j.top_probability);
  };
  if (follow_up.left_out)
    if (const WithoutTruth without = withoutTruth(*follow_up.left_out, follow_up.answer);
        without == WithoutTruth::failed || without == WithoutTruth::confidently_wrong || without == WithoutTruth::class_mate)
      misses.push_back("without the true effect: " + said(*follow_up.left_out));
  if (follow_up.experiment && !namesTruth(*follow_up.experiment))
    misses.push_back("after the proposed schedule: " + said(*follow_up.experiment));
  if (const auto& fresh = follow_up.fresh; fresh && fresh->diverged)
    misses.push_back("on a fresh recording the model with the effects diverged");
  else if (fresh && fresh->interval_percent && !fresh->isWithin())
    misses.push_back(fmt::format("on a fresh recording {:.1f} % instead of {:.1f} ({:.1f} to {:.1f})", fresh->reduction_percent,
                                 fresh->reported_percent, fresh->interval_percent->first, fresh->interval_percent->second));
  return misses;
}

}  // namespace musclesim::blind
