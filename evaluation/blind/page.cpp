#include "page.h"

#include <fmt/format.h>

#include "benchmark.h"
#include "figures.h"
#include "kind.h"
#include "musclesim/base/file.h"

namespace musclesim::blind {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr double percent = 100;

std::string numberText(const json& totals, const std::string& name, const std::string& format) {
  return totals.contains(name) ? fmt::format(fmt::runtime(format), totals[name].get<double>()) : "-";
}

/// "83 % (5/6)".
std::string shortRate(const json& totals, const std::string& name) {
  if (!totals.contains(name)) return "-";
  const json& rate = totals[name];
  return fmt::format("{:.0f} % ({}/{})", percent * rate["value"].get<double>(), rate["hits"].get<int>(), rate["count"].get<int>());
}

/// "83 %, 5 of 6, 44 .. 97 %".
std::string longRate(const json& totals, const std::string& name) {
  if (!totals.contains(name)) return "no case";
  const json& rate = totals[name];
  return fmt::format("{:.0f} %, {} of {}, {:.0f} .. {:.0f} %", percent * rate["value"].get<double>(), rate["hits"].get<int>(),
                     rate["count"].get<int>(), percent * rate["low"].get<double>(), percent * rate["high"].get<double>());
}

std::string valueOr(const json& object, const std::string& name, const std::string& missing) {
  return object.contains(name) ? object[name].get<std::string>() : missing;
}

std::string introduction(const Score& score) {
  const json &seal = score.seal, &answers = score.answers;
  return fmt::format(
      R"(# The diagnosis on withheld causes

<!-- Made by scripts/make_blind_docs.sh; do not edit. -->

`musclesim blind make` draws plants: a robot, up to five causes, components, sizes, excitations, sensors. The truth is simulated with other laws than the catalogue's (a lag that grows with the pressure, Bouc-Wen for play, LuGre for Coulomb), with a cause that the catalogue does not have, or without a cause; half of the plants with several causes have causes and sizes that were measured together on real machines. In four of five plants numbers that nobody measures (masses, inertias, friction, constants of the force law) differ from the model's. The plant has half the internal step of the model (arm: the same step, because a finer one alone moves its hand by millimetres), other seeds and sensor noise. The key is sealed; `musclesim blind run` diagnoses without it and refuses to start if the key is within reach; `musclesim blind score` checks all fingerprints, then opens the key. [Diagnosing](../developer/diagnosis.md) explains the method that is tested here.

| | |
|---|---|
| cases | {} |
| seed | {} |
| seconds per recording (arm: half) | {} |
| sealed with | {}, {} |
| diagnosed with | {}, {}, program SHA-256 `{}` |
| SHA-256 of key, recordings, answers | `{}`, `{}`, `{}` |

Sizes are the largest RMS gap of any signal over its noise: weak 2..6, clear 6..40, strong 40..200. An answer is *acceptable* if it names the cause and its component, or one of the look-alikes that the measured signals cannot separate; these were frozen when the cases were made. *Probability* is that of the first effect, of none of these or of no gap, whichever is largest. The oracle is the true effect's best fit; where the answer does not list it, and for several causes, what the true laws remove while the model keeps its own numbers. Intervals: 95 %, Wilson.

)",
      score.cases.size(), seal.value("seed", json(0)).dump(), seal.value("duration_s", json(0)).dump(), valueOr(seal, "program", "-"),
      valueOr(seal, "commit", "commit not noted"), valueOr(answers, "program", "-"), valueOr(answers, "commit", "commit not noted"),
      valueOr(answers, "program_sha256", "-"), valueOr(seal, "key_sha256", "-"), valueOr(seal, "recordings_sha256", "-"),
      valueOr(answers, "answers_sha256", "-"));
}

std::string overview(const json& totals) {
  const json &all = totals["all"], kinds = totals.value("by_kind", json::object());
  const json none = json::object(), single = kinds.value("single", none), several = totals.value("several", none);
  std::string text = "## In all\n\n| measure | aim | found |\n|---|---|---|\n";
  auto row = [&](const char* what, const char* aim, const std::string& found) {
    text += fmt::format("| {} | {} | {} |\n", what, aim, found);
  };
  row("verdict right, all kinds", "", longRate(all, "verdict"));
  row("acceptable answer first, and likelier than none of these and no gap, single", ">= 80 %", longRate(single, "acceptable"));
  row("acceptable answer among the first three, single", ">= 95 %", longRate(single, "acceptable3"));
  row("true effect first / among the first three, single", "", longRate(single, "top1") + " / " + longRate(single, "top3"));
  row("true effect first, on its component, likelier than none of these and no gap, single", "", longRate(single, "named"));
  row("component right where the effect is", "", longRate(single, "component"));
  row("mean probability on the truth, single", ">= 0.70", numberText(single, "probability_of_truth", "{:.2f}"));
  row("mean probability on the acceptable set, single", "", numberText(single, "probability_of_acceptable", "{:.2f}"));
  row("first stage of `where`, all kinds with a cause", ">= 85 %", longRate(all, "stage"));
  row("truth in the ambiguity set or chosen, single", ">= 95 %", longRate(single, "covered"));
  row("mean size of the ambiguity set, single", "<= 2.5", numberText(single, "set_size", "{:.2f}"));
  row("every demanded cause and no other one chosen, several causes", "", longRate(several, "full_set"));
  row("demanded causes chosen, several causes", "", longRate(several, "demanded_found"));
  row("\"unexplained\" or a significant remainder where every cause is known", "", longRate(all, "unknown_claimed"));
  row("a cause was chosen that is not present, single", "", longRate(single, "spurious"));
  row("calibration error, single and open", "<= 0.05", numberText(all, "calibration_error", "{:.3f}"));
  if (all.contains("calibration_error_by_chance"))
    row("... of perfect probabilities, by chance: mean, 95 % quantile", "",
        fmt::format("{:.3f}, {:.3f}", all["calibration_error_by_chance"]["mean"].get<double>(),
                    all["calibration_error_by_chance"]["high"].get<double>()));
  row("calibration error, all kinds", "", numberText(all, "calibration_error_all_kinds", "{:.3f}"));
  row("open causes called unexplained, or no effect above probability 0.5", ">= 80 %", longRate(all, "open_detected"));
  row("false alarms without any cause", "<= 5 %", longRate(all, "false_alarm"));
  row("median gap reduction on held-out data, known causes", "", numberText(all, "shrink_median_percent", "{:.0f} %"));
  row("gap reduction of at least 80 %", "", longRate(all, "shrink_at_least_80_percent"));
  row("gap reduction of at least 80 % of the oracle's", "", longRate(all, "shrink_at_least_80_percent_of_true_effect"));
  row("the answer lists the oracle's fit, single", "", longRate(single, "true_effect_listed"));
  row("20 points above the nominal refit, gaps of three times the noise and more", "",
      longRate(all, "shrink_20_points_above_nominal_refit"));
  row("median seconds per case, one thread", "", numberText(all, "seconds_median", "{:.0f}"));
  return text + "\n";
}

/// The benchmark, and how often effects acted that had a probability.
std::string severalCauses(const json& totals) {
  std::string text =
      "## Several causes\n\nA cause is *demanded* if, with it left out and everything else refitted to stand in for it, at least "
      "three noise floors and a tenth of the plant's gap remain in some signal; others are neither missed nor wrong. A set is *full* "
      "if it holds every demanded cause, or a look-alike that the measured signals cannot separate from it, and nothing that does not "
      "act.\n\n" +
      benchmarkTable(totals) +
      "\nThe probability of an effect (look-alikes of one cause together) and how often it acted:\n\n| mean probability | effects | "
      "acted |\n|---|---|---|\n";
  for (const json& bin : totals["all"].value("inclusion_reliability", json::array()))
    if (bin["count"].get<int>() > 0)
      text += fmt::format("| {:.2f} | {} | {:.2f} ({:.2f} .. {:.2f}) |\n", bin["mean_probability"].get<double>(), bin["count"].get<int>(),
                          bin["value"].get<double>(), bin["low"].get<double>(), bin["high"].get<double>());
  return text + "\n";
}

std::string groupTable(const std::string& title, const json& groups) {
  std::string text = fmt::format(
      "## By {}\n\n| {} | cases | verdict | effect first | among three | acceptable | full set | found | wrong | on the truth | stage | "
      "covered "
      "| set | gap reduction | false alarms | unknown told | s |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      title, title);
  for (const auto& [name, t] : groups.items())
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name,
                        t["cases"].get<int>(), shortRate(t, "verdict"), shortRate(t, "top1"), shortRate(t, "top3"),
                        shortRate(t, "acceptable"), shortRate(t, "full_set"), shortRate(t, "demanded_found"),
                        numberText(t, "wrong_effects", "{:.2f}"), numberText(t, "probability_of_truth", "{:.2f}"), shortRate(t, "stage"),
                        shortRate(t, "covered"), numberText(t, "set_size", "{:.1f}"), numberText(t, "shrink_median_percent", "{:.0f} %"),
                        shortRate(t, "false_alarm"), shortRate(t, "unknown_told"), numberText(t, "seconds_median", "{:.0f}"));
  return text + "\n";
}

std::string followUpMisses(const std::vector<FollowUp>& follow_ups) {
  std::string rows;
  for (const FollowUp& one : follow_ups)
    for (const std::string& miss : missesOf(one))
      rows += fmt::format("| {} | {} | {:.1f} | {} | {} |\n", one.answer.name, one.answer.robot, one.answer.gap_over_noise,
                          one.answer.truth, miss);
  return rows.empty() ? "" : "| case | robot | gap / noise | true | what was missed |\n|---|---|---|---|---|\n" + rows + "\n";
}

/// The follow-ups; empty if there are none.
std::string followed(const Score& score) {
  const json totals = score.totals.value("follow_up", json::object());
  if (totals.empty()) return "";
  std::string text = fmt::format(
      "## Follow-up of the answers\n\n`musclesim blind follow` followed up on {} of {} answers. An answer to a single cause is ambiguous "
      "if it names an effect that it cannot distinguish from others.\n\n| measure | aim | found |\n|---|---|---|\n",
      totals.at("followed_count").get<int>(), score.cases.size());
  auto row = [&](const char* what, const char* aim, const char* name) {
    text += fmt::format("| {} | {} | {} |\n", what, aim, longRate(totals, name));
  };
  row("true effect not among the candidates: a wrong cause with more than 0.9 that is no look-alike", "<= 5 %",
      "left_out_confidently_wrong");
  row("... an acceptable look-alike, at any probability", "", "left_out_look_alike");
  row("... an effect from the ambiguity set of the answer with all candidates, at any probability", "", "left_out_named_before");
  row("... with more than 0.9 another effect of its class, which some recordings cannot distinguish from it (effects.md)", "",
      "left_out_class_mate");
  row("... unexplained", "", "left_out_unexplained");
  row("... a wrong cause with 0.9 or less", "", "left_out_unsure");
  row("... no answer", "", "left_out_failed");
  row("ambiguous answers: the truth is the single best before", "", "experiment_truth_first_before");
  row("... after the proposed schedule", ">= 80 %", "experiment_truth_first");
  row("... after it, if the ambiguity set held the truth", "", "experiment_truth_first_where_covered");
  row("... after it, and the ambiguity set holds nothing else", "", "experiment_alone");
  row("the gap reduction by the effects and numbers of the answer on a new recording is within the reported interval", "", "fresh_within");
  row("... the interval is no wider than 20 points", "", "fresh_narrow");
  row("... of these within the interval", "", "fresh_within_narrow");
  text += fmt::format("| median width of the interval, points | | {} |\n", numberText(totals, "fresh_median_width_points", "{:.1f}"));
  text += fmt::format("| median difference between that gap reduction and the reported one, points | | {} |\n\n",
                      numberText(totals, "fresh_median_difference_points", "{:.2f}"));
  return text + followUpMisses(score.follow_ups);
}

/// The fault of the named causes; empty if there is none.
std::string wrongCause(const Judgement& j) {
  if (j.kind == "null") return j.false_alarm.value_or(false) ? "false alarm" : "";
  if (j.verdict == "failed") return "no answer: " + j.message;
  if (j.kind == "open") return j.open_detected.value_or(false) ? "" : j.verdict == "no_gap" ? "gap not seen" : "named a wrong cause";
  if (j.verdict == "no_gap") return "gap not seen";
  if (kindOf(j.kind).isSeveral() && !j.set.full.value_or(true))
    return fmt::format("{} of {} causes found, {} wrong", j.set.found, j.set.demanded, j.set.wrong);
  if (!j.set.unknown_told.value_or(true)) return "unknown cause not told";
  if (j.acceptable.value_or(true)) return j.spurious.value_or(false) ? "a further cause that is not present" : "";
  if (j.namesEffect() && j.top1.value_or(false)) return "component";
  return std::string(j.namesEffect() ? "wrong cause" : "no cause named") + (j.covered.value_or(false) ? ", truth in the set" : "");
}

/// Why a case counts as failed; empty if it does not.
std::string failureOf(const Judgement& j) {
  constexpr double enough_share = 0.8;
  std::vector<std::string> reasons;
  if (const std::string wrong = wrongCause(j); !wrong.empty()) reasons.push_back(wrong);
  if (reasons.empty() && !j.verdict_right) reasons.emplace_back("verdict");
  if (reasons.empty() && j.oracle_share.value_or(1) < enough_share)
    reasons.push_back(fmt::format("removes {:.0f} % of what the true effect removes", percent * std::max(0.0, *j.oracle_share)));
  if (j.stage && !*j.stage) reasons.emplace_back("stage");
  return fmt::format("{}", fmt::join(reasons, "; "));
}

std::string said(const Judgement& j) {
  if (j.verdict == "failed") return "nothing";
  if (j.namesEffect()) return j.top;
  return j.no_effect >= j.confidence() ? "no gap" : "none of these";
}

std::string failures(const Score& score) {
  std::string text =
      "## Every failure\n\n| case | robot | kind | size | gap / noise | true | said | probability | verdict | what failed "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n";
  int count = 0;
  for (const Judgement& j : score.cases) {
    const std::string failure = failureOf(j);
    if (failure.empty()) continue;
    ++count;
    text += fmt::format("| {} | {} | {} | {} | {:.1f} | {} | {} | {:.2f} | {} | {} |\n", j.name, j.robot, j.kind, j.size, j.gap_over_noise,
                        j.truth.empty() ? "none" : j.truth, said(j), j.confidence(), j.verdict, failure);
  }
  return text + fmt::format("\n{} of {} cases.\n", count, score.cases.size());
}

}  // namespace

std::string pageText(const Score& score) {
  const json& totals = score.totals;
  return introduction(score) + severalCauses(totals) + overview(totals) +
         "![How often answers were right over the probability given](figures/blind_reliability.svg)\n\n![Share of causes found over the "
         "size of the gap](figures/blind_detectability.svg)\n\n![True stage against answered stage](figures/blind_confusion.svg)\n\n" +
         groupTable("kind", totals["by_kind"]) + groupTable("robot", totals["by_robot"]) + groupTable("size", totals["by_size"]) +
         groupTable("effect", totals["by_effect"]) + followed(score) + failures(score);
}

void writePage(const Score& score, const fs::path& folder) {
  const fs::path figures = folder / "figures";
  fs::create_directories(figures);
  replaceFile((folder / "blind.md").string(), pageText(score));
  replaceFile((figures / "blind_reliability.svg").string(), reliabilitySvg(score));
  replaceFile((figures / "blind_detectability.svg").string(), detectabilitySvg(score));
  replaceFile((figures / "blind_confusion.svg").string(), confusionSvg(score));
}

}  // namespace musclesim::blind
