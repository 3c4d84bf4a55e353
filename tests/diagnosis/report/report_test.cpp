// The contents of report.html.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "../sample_diagnosis.h"
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
  EXPECT_LT(page.find("Robot rig"), page.find("class=\"verdict"));
}

TEST(Report, TellsTheNamesOfMuscles) {
  Diagnosis d = answer(Verdict::unexplained);
  EXPECT_FALSE(contains(diagnosisReport(d), "Muscles:"));
  d.muscle_names = {"flexor", "extensor <left>"};
  EXPECT_TRUE(contains(diagnosisReport(d), "fast.csv. Muscles: 0 flexor, 1 extensor &lt;left&gt;."));
  EXPECT_TRUE(contains(diagnosisSummary(d), "muscles   0 flexor, 1 extensor <left>\n"));
  EXPECT_TRUE(contains(diagnosisJson(d), R"("muscle_names": [)"));
}

TEST(Report, SaysInPlainWordsWhatToBelieve) {
  const std::string page = diagnosisReport(sampleDiagnosis());
  EXPECT_TRUE(contains(page, "<strong>Explained</strong>"));
  EXPECT_TRUE(contains(
      page, "<li>The pressure of muscle 1 comes late: a dead time of 25 ms and a lag of 40 ms (filling) and 70 ms (venting).</li>"));
  EXPECT_TRUE(contains(page, "<li>The hand carries more than in the model: by 0.2 kg.</li>"));
  EXPECT_TRUE(contains(page, "You can believe place, kind and numbers of the causes below."));
  EXPECT_TRUE(contains(page, "Together they explain 97.0 % of the"));
  for (const char* question : {"Where", "How sure", "How much is left", "What to do next"})
    EXPECT_TRUE(contains(page, "<dt>" + std::string(question) + "</dt>")) << question;
}

TEST(Report, SignTellsHowFarTheAnswerCanBeBelieved) {
  Diagnosis d = sampleDiagnosis();
  d.after.normalised = 8;
  EXPECT_TRUE(contains(diagnosisReport(d), "<strong>Explained in part</strong>")) << "a rest of three noise floors";
  d = sampleDiagnosis();
  d.alternatives = {"leak@muscle_0", "creep@muscle_0"};
  EXPECT_TRUE(contains(diagnosisReport(d), "<strong>Explained in part</strong>")) << "another cause is as good";
  d = sampleDiagnosis();
  d.none_of_these = 0.5;
  EXPECT_TRUE(contains(diagnosisReport(d), "<strong>Explained in part</strong>")) << "it holds too little on the held-out recording";
  d = sampleDiagnosis();
  d.unsteady = {"angle_elbow_deg", 50, 0.3};
  EXPECT_TRUE(contains(diagnosisReport(d), "<strong>Explained in part</strong>")) << "small errors move the model by a part of the gap";
  EXPECT_TRUE(contains(diagnosisReport(d), "record gentler motions"));
  d = sampleDiagnosis();
  d.partial = true;
  EXPECT_TRUE(contains(diagnosisReport(d), "<strong>Cannot tell</strong>"));
  EXPECT_TRUE(contains(diagnosisReport(answer(Verdict::unexplained)), "<strong>Cannot tell</strong>"));
  EXPECT_TRUE(contains(diagnosisReport(answer(Verdict::not_excited)), "<strong>Cannot tell</strong>"));
  EXPECT_TRUE(contains(diagnosisReport(answer(Verdict::no_gap)), "<strong>No gap</strong>"));
}

TEST(Report, GivesIntervalsOnlyWhereTheySaySomething) {
  const std::string page = diagnosisReport(sampleDiagnosis());
  EXPECT_TRUE(contains(page, "38 to 42 ms"));
  EXPECT_FALSE(contains(page, "231303"));
  EXPECT_FALSE(contains(page, "second lag in series")) << "a parameter that does nothing";
}

TEST(Report, ShowsWhatEachCauseRemoves) {
  const std::string page = diagnosisReport(sampleDiagnosis());
  const std::string stack = page.substr(page.find("What each cause removes"));
  EXPECT_LT(stack.find("with lag of the valve (muscle 1)"), stack.find("with dead time (muscle 1)"));
  EXPECT_TRUE(contains(stack, "\u2212 70 %"));
  EXPECT_TRUE(contains(stack, "\u2212 18 %"));
  EXPECT_TRUE(contains(stack, "\u2212 9 %"));
  Diagnosis d = sampleDiagnosis();
  d.removal[1].left_percent = 40;
  EXPECT_TRUE(contains(diagnosisReport(d), "+ 10 %")) << "the gap may grow while a cause is missing";
}

TEST(Report, ShowsLoopsWhereACauseActsBehindThePressure) {
  Diagnosis d = sampleDiagnosis();
  EXPECT_TRUE(contains(diagnosisReport(d), "length of muscle 0 over pressure of muscle 0"));
  d.traces.push_back({"fast.csv", "angle_hip_deg", {0, 1, 2}, {1, 2, 3}, {1, 2, 3}, {}});
  d.traces.push_back({"fast.csv", "angle_knee_deg", {0, 1, 2}, {1, 2, 3}, {1, 2, 3}, {}});
  EXPECT_TRUE(contains(diagnosisReport(d), "angle of the hip joint over")) << "every joint has a loop";
  EXPECT_TRUE(contains(diagnosisReport(d), "angle of the knee joint over"));
  d.chosen.pop_back();
  EXPECT_FALSE(contains(diagnosisReport(d), "<h2>Loops"));
}

TEST(Report, SaysThatSeveralCausesWouldExplainTheGap) {
  Diagnosis d = answer(Verdict::unexplained);
  d.effects = {{"leak", "muscle_0", 0.37, {}}};
  d.ambiguity_sets = {{"leak@muscle_0"}, {"creep@muscle_0"}, {"payload@hand", "creep@muscle_0"}, {"force_gain@muscle_0"}};
  const std::string page = diagnosisReport(d);
  EXPECT_TRUE(
      contains(page, "There is a gap that I cannot explain. The likeliest cause, leak (muscle 0), has a probability of only 37 %."));
  EXPECT_TRUE(contains(page, "Possible: leak (muscle 0), or creep (muscle 0), or other load (the hand) with creep (muscle 0), or 1 more."));
  EXPECT_TRUE(contains(page, "The largest residual is 10 times its noise floor (pressure of muscle 0)."));
  d.none_of_these = 0.9;
  EXPECT_FALSE(contains(diagnosisReport(d), "Possible:")) << "none of them does";
}

TEST(Report, IsSureOfACauseThatAllGoodExplanationsShare) {
  Diagnosis d = sampleDiagnosis();
  d.chosen = {"valve_lag@muscle_1"};
  d.explanations = {{d.chosen, 0.2}};
  d.alternatives = {"valve_lag@muscle_1", "valve_lag@muscle_1 + leak@muscle_0"};
  d.ambiguity_sets = {{"valve_lag@muscle_1"}, {"leak@muscle_0", "valve_lag@muscle_1"}};
  std::string page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "<strong>Explained</strong>"));
  EXPECT_TRUE(contains(page, "You can believe place, kind and numbers of the cause below."));
  EXPECT_TRUE(contains(page, "of 98 %; that nothing else acts, 20 %."));
  EXPECT_TRUE(contains(page, "These recordings leave 2 explanations possible. All hold lag of the valve (muscle 1)"));
  d.ambiguity_sets[1] = {"leak@muscle_0"};
  page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "<strong>Explained in part</strong>"));
  EXPECT_TRUE(contains(page, "Less likely, but possible: leak (muscle 0)."));
}

TEST(Report, DoesNotPromiseNumbersBeyondWhatIsUsual) {
  Diagnosis d = sampleDiagnosis();
  d.chosen = {"volume_coupling@all"};
  d.effects = {{"volume_coupling", "all", 0.98, {{"polytropic_exponent", {0.93, 0.85, 1.0}}}}};
  EXPECT_TRUE(contains(diagnosisReport(d),
                       "You can believe the place of the cause below. Check the kind and its numbers: polytropic exponent "
                       "(motion changes the pressure) is beyond what is usual."));
}

TEST(Report, SaysWhereCausesWereFoundThatTheSignalsDoNotShow) {
  const Diagnosis d = sampleDiagnosis();  // the signals rule out the body, where the payload acts
  EXPECT_TRUE(contains(diagnosisReport(d), ">cause found</text>"));
  const auto json = nlohmann::json::parse(diagnosisJson(d));
  for (const auto& place : json.at("where")) {
    const std::string stage = place.at("stage");
    EXPECT_EQ(place.contains("found"), stage == "command" || stage == "pressure" || stage == "body") << stage;
    EXPECT_EQ(place.at("ruled_out"), stage == "force" || stage == "sensor") << stage;
  }
}

TEST(Report, ExplainsInPartWhatAWrongNumberWouldExplain) {
  Diagnosis d = sampleDiagnosis();
  d.numbers_instead = {{"elbow.load_kg", "kg", 1, 1.2, {"payload@hand"}}};
  EXPECT_TRUE(contains(diagnosisReport(d), "<strong>Explained in part</strong>A wrong number of the model would do what a cause does"));
}

TEST(Report, ExplainsInPartWithACauseThatDoesNotHold) {
  Diagnosis d = sampleDiagnosis();
  d.effects[2].removes_percent = -7;
  const std::string page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "<strong>Explained in part</strong>Not every cause below holds on the data not used for fitting"));
}

TEST(Report, SaysWhereTheSignalsAloneDoNotConfirmACause) {
  const std::string page = diagnosisReport(sampleDiagnosis());
  EXPECT_TRUE(contains(page, "in the body stage (the hand). The signals alone do not confirm the body stage."));
  Diagnosis d = sampleDiagnosis();
  d.chosen.pop_back();
  EXPECT_FALSE(contains(diagnosisReport(d), "do not confirm"));
}

TEST(Report, TellsHowItWasMade) {
  const std::string page = diagnosisReport(sampleDiagnosis(), {"2026-01-02 03:04", "musclesim diagnose 'a b.csv'"});
  EXPECT_TRUE(contains(page, "2026-01-02 03:04"));
  EXPECT_TRUE(contains(page, "musclesim diagnose &#39;a b.csv&#39;"));
}

TEST(Report, SaysHowLikelyNoneOfThemIsEvenIfNothingElseIs) {
  Diagnosis d = answer(Verdict::unexplained);
  d.none_of_these = 0.999;
  d.alternatives = {"leak@muscle_0", "creep@muscle_0"};
  const std::string page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "none of these</td><td class=number data-head=probability>over 99 %</td>"));
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
  EXPECT_TRUE(contains(page, "<b>-12.9 N</b></td><td class=small>-13.2 to -12.6 N; usual range -10 to 10 N"));
  EXPECT_FALSE(contains(page, "2.40 N; usual"));
  d.effects.front().parameters["force_y_N"] = {-10000, -10000, -9000};
  EXPECT_TRUE(contains(diagnosisReport(d), "at its bound"));
}

TEST(Report, TellsParametersThatAreWords) {
  Diagnosis d = answer(Verdict::effects_found);
  d.effects = {{"attachment_offset", "muscle_0", 0.9, {{"offset_mm", {4.3, 4.2, 4.4}}}, 99, {}, {{"attachment", "end"}}}};
  d.chosen = {"attachment_offset@muscle_0"};
  EXPECT_TRUE(contains(diagnosisReport(d), "<td>attachment</td><td class=number><b>end</b></td>"));
  EXPECT_TRUE(contains(diagnosisReport(d), "<b>4.30 mm</b>"));
  EXPECT_TRUE(contains(diagnosisJson(d), "\"choices\": {"));
  d.effects.front().choices.clear();
  EXPECT_FALSE(contains(diagnosisJson(d), "\"choices\""));
  d = answer(Verdict::unexplained);
  d.effects = {{"leak", "muscle_0", 0.1, {}}};
  d.attempt.effects = {"attachment_offset@muscle_0"};
  d.attempt.active_effects = {{"attachment_offset", "muscle_0", {{"offset_mm", 4.3}, {"attachment", std::string("end")}}}};
  EXPECT_TRUE(contains(diagnosisReport(d), "<td>attachment</td><td class=number><b>end</b></td>"));
}

TEST(Report, ListsEffectsThatActTogetherTogether) {
  Diagnosis d = answer(Verdict::effects_found);
  d.effects = {{"payload", "hand", 0.98, {}, 84}, {"leak", "all", 0.2, {}, 10}};
  d.chosen = {"payload@hand", "leak@all"};
  d.explanations = {{d.chosen, 0.2}, {{"payload@hand"}, 0.78}};
  const std::string page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "<li>20 %: other load (the hand) with leak (every muscle)</li><li>78 %: other load (the hand)</li>"));
}

TEST(Report, GivesTheParametersOfTheBestRejectedExplanation) {
  Diagnosis d = answer(Verdict::unexplained);
  d.none_of_these = 0.9;
  d.attempt.effects = {"leak@muscle_0"};
  d.attempt.active_effects = {{"leak", "muscle_0", {{"leak_per_s", 2.5}}}};
  const std::string page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "No explanation is believed."));
  EXPECT_TRUE(contains(page, "<b>2.5 per second</b></td><td class=small>usual range 0.0003 to 1 per second"));
}

TEST(Report, ShowsTheLargestGapFirst) {
  const std::string page = diagnosisReport(answer(Verdict::unexplained));
  EXPECT_LT(page.find("data-signal=\"pressure_0\""), page.find("data-signal=\"length_0_mm\""));
}

TEST(Report, ListsEveryScreenedEffectOnceAndTheChosenOnes) {
  Diagnosis d = answer(Verdict::effects_found);
  d.effects = {{"creep", "muscle_0", 0.9, {}, 84}};
  d.chosen = {"creep@muscle_0"};
  for (int muscle = 1; muscle < 20; ++muscle) d.screenings.push_back({"leak@muscle_" + std::to_string(muscle), 0.3});
  d.screenings.push_back({"creep@muscle_0", 0.1});
  const std::string page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "1. leak (muscle 0)"));
  EXPECT_FALSE(contains(page, "2. leak (muscle 0)"));
  EXPECT_TRUE(contains(page, "12. leak (muscle 11)"));
  EXPECT_FALSE(contains(page, "13. leak (muscle 12)"));
  EXPECT_TRUE(contains(page, "21. creep (muscle 0)"));
}

TEST(Report, ClaimsNothingOfASearchWhereThereWasNone) {
  const std::string page = diagnosisReport(answer(Verdict::no_gap));
  EXPECT_FALSE(contains(page, "held out from fitting"));
  EXPECT_FALSE(contains(page, "<h2>Which"));
  EXPECT_TRUE(contains(page, "noise up to 1.15 times"));
  EXPECT_TRUE(contains(page, "Use the model as it is"));
}

TEST(Report, WhereFittedNumbersExplainTheGapTheModelIsToBeUsedWithThem) {
  Diagnosis d = answer(Verdict::no_gap);
  d.reduction_percent = 99.9;
  d.numbers = {{"elbow.forearm_kg", "kg", 0.6, {0.61, 0.6, 0.62, true}, 1}};
  const std::string page = diagnosisReport(d);
  EXPECT_TRUE(contains(page, "--config nominal.toml"));
  EXPECT_TRUE(contains(page, "0.610 (0.600 to 0.620)"));
  EXPECT_FALSE(contains(page, "Use the model as it is"));
  EXPECT_FALSE(contains(page, "no signal stands out of its noise"));
  EXPECT_FALSE(contains(page, "no effect was fitted"));
  const std::string summary = diagnosisSummary(d);
  EXPECT_TRUE(contains(summary, "elbow.forearm_kg = 0.610 (0.600 to 0.620) kg, given as 0.6")) << summary;
  EXPECT_FALSE(contains(summary, "where ")) << summary;
}

}  // namespace
}  // namespace musclesim
