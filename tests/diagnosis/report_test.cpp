// The contents of report.html.
#include <gtest/gtest.h>

#include "musclesim/diagnosis/diagnosis.h"
#include "support/support.h"

namespace musclesim {
namespace {

Diagnosis answer(Verdict verdict) {
  Diagnosis d;
  d.robot = "rig";
  d.verdict = verdict;
  d.recordings = {"/data/day 1/slow.csv", "/data/day 1/fast.csv"};
  d.held_out = "fast.csv, held out from fitting and choosing";
  d.before.per_signal = {{"length_0_mm", {0.3, 0.1}}, {"pressure_0", {0.02, 0.002}}};
  d.after = d.before;
  d.where = {{"pressure", "muscle_0", "", 0.6}, {"command", "muscle_0", "", 0.4}, {"force", "all", "", 0, true}};
  d.traces = {{"fast.csv", "length_0_mm", {0, 1}, {1, 2}, {1, 3}, {}}, {"fast.csv", "pressure_0", {0, 1}, {0, 1}, {0, 0}, {}}};
  d.screenings = {{"leak@muscle_0", 0.5}, {"leak@muscle_0", 0.4}};
  return d;
}

TEST(Report, NamesRobotAndRecordingsFirst) {
  const std::string page = diagnosisReport(answer(Verdict::unexplained));
  EXPECT_TRUE(contains(page, "Robot rig; recordings slow.csv, fast.csv."));
  EXPECT_LT(page.find("Robot rig"), page.find("class=verdict"));
}

TEST(Report, SaysHowLikelyNoneOfThemIsEvenIfNothingElseIs) {
  Diagnosis d = answer(Verdict::unexplained);
  d.none_of_these = 0.999;
  d.alternatives = {"leak@muscle_0", "creep@muscle_0"};
  const std::string page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "<td>none of these</td><td class=number>over 99 %</td>"));
  EXPECT_FALSE(contains(page, "cannot distinguish"));
}

TEST(Report, FramesEveryStageThatMayBeThePlace) {
  auto frames = [](const Diagnosis& d) {
    const std::string page = diagnosisReport(d);
    int count = 0;
    for (std::size_t at = page.find("stroke-width=\"4\""); at != std::string::npos; at = page.find("stroke-width=\"4\"", at + 1)) ++count;
    return count;
  };
  Diagnosis d = answer(Verdict::unexplained);
  EXPECT_EQ(frames(d), 2);
  d.where[1].is_ruled_out = true;
  EXPECT_EQ(frames(d), 1);
  d.where[2].is_ruled_out = false;
  EXPECT_EQ(frames(d), 0);
}

TEST(Report, RemarksOnNumbersThatNoPlantIsKnownToHave) {
  Diagnosis d = answer(Verdict::effects_found);
  d.effects = {{"external_force", "hand", 0.9, {{"force_x_N", {2.35, 2.3, 2.4}}, {"force_y_N", {-12.92, -13.2, -12.6}}}, 99}};
  d.chosen = {"external_force@hand"};
  const std::string page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "force_<wbr>y_<wbr>N = -12.9 (-13.2 to -12.6), usual range -10 to 10"));
  EXPECT_FALSE(contains(page, "(2.30 to 2.40), usual"));
  d.effects.front().parameters["force_y_N"] = {-10000, -10000, -9000};
  EXPECT_TRUE(contains(diagnosisReport(d), "at its bound"));
}

TEST(Report, TellsParametersThatAreWords) {
  Diagnosis d = answer(Verdict::effects_found);
  d.effects = {{"attachment_offset", "muscle_0", 0.9, {{"offset_mm", {4.3, 4.2, 4.4}}}, 99, {}, {{"attachment", "end"}}}};
  d.chosen = {"attachment_offset@muscle_0"};
  EXPECT_TRUE(contains(diagnosisReport(d), "attachment = end<br>offset_<wbr>mm = 4.3"));
  EXPECT_TRUE(contains(diagnosisJson(d), "\"choices\": {"));
  d.effects.front().choices.clear();
  EXPECT_FALSE(contains(diagnosisJson(d), "\"choices\""));
  d = answer(Verdict::unexplained);
  d.attempt.effects = {"attachment_offset@muscle_0"};
  d.attempt.active_effects = {{"attachment_offset", "muscle_0", {{"offset_mm", 4.3}, {"attachment", std::string("end")}}}};
  EXPECT_TRUE(contains(diagnosisReport(d), "attachment_offset@muscle_0 (attachment = end, offset_mm = 4.3)"));
}

TEST(Report, ListsEffectsThatActTogetherTogether) {
  Diagnosis d = answer(Verdict::effects_found);
  d.effects = {{"payload", "hand", 0.98, {}, 84}, {"leak", "all", 0.2, {}, 10}};
  d.chosen = {"payload@hand", "leak@all"};
  d.explanations = {{d.chosen, 0.2}, {{"payload@hand"}, 0.78}};
  EXPECT_TRUE(contains(diagnosisReport(d), "By explanation: payload@hand + leak@all 20 %, payload@hand 78 %."));
}

TEST(Report, GivesTheParametersOfTheBestRejectedHypothesis) {
  Diagnosis d = answer(Verdict::unexplained);
  d.attempt.effects = {"leak@muscle_0"};
  d.attempt.active_effects = {{"leak", "muscle_0", {{"leak_per_s", 2.5}}}};
  EXPECT_TRUE(contains(diagnosisReport(d), "Best rejected hypothesis: leak@muscle_0 (leak_per_s = 2.5, usual range 0.0003 to 1)."));
}

TEST(Report, ShowsTheLargestGapFirst) {
  const std::string page = diagnosisReport(answer(Verdict::unexplained));
  EXPECT_LT(page.find("<h3><code>pressure_0"), page.find("<h3><code>length_0_mm"));
}

TEST(Report, ListsEveryScreenedEffectOnceAndTheChosenOnes) {
  Diagnosis d = answer(Verdict::effects_found);
  d.effects = {{"creep", "muscle_0", 0.9, {}, 84}};
  d.chosen = {"creep@muscle_0"};
  for (int muscle = 1; muscle < 20; ++muscle) d.screenings.push_back({"leak@muscle_" + std::to_string(muscle), 0.3});
  d.screenings.push_back({"creep@muscle_0", 0.1});
  const std::string page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "1. leak@muscle_0"));
  EXPECT_FALSE(contains(page, "2. leak@muscle_0"));
  EXPECT_TRUE(contains(page, "12. leak@muscle_11"));
  EXPECT_FALSE(contains(page, "13. leak@muscle_12"));
  EXPECT_TRUE(contains(page, "21. creep@muscle_0"));
}

TEST(Report, ClaimsNothingOfASearchWhereThereWasNone) {
  const std::string page = diagnosisReport(answer(Verdict::no_gap));
  EXPECT_FALSE(contains(page, "held out from fitting"));
  EXPECT_FALSE(contains(page, "<h2>Which"));
  EXPECT_TRUE(contains(page, "1.15 times its noise floor, 1.3 times"));
}

}  // namespace
}  // namespace musclesim
