// Answers written by hand against keys written by hand; the numbers were computed on paper.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "blind_answers.h"
#include "evaluation/blind/figures.h"
#include "evaluation/blind/judge.h"
#include "evaluation/blind/look_alikes.h"
#include "evaluation/blind/page.h"
#include "evaluation/blind/score.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim::blind {
namespace {

using namespace answers;

TEST(BlindJudge, CountsARightAndAWrongAnswer) {
  const Judgement right = rightSingle(), wrong = wrongSingle();
  EXPECT_TRUE(*right.top1 && *right.acceptable && *right.component && *right.stage && *right.covered && right.verdict_right);
  EXPECT_DOUBLE_EQ(*right.probability_of_truth, 0.7);
  EXPECT_DOUBLE_EQ(*right.probability_of_acceptable, 0.9);
  EXPECT_DOUBLE_EQ(*right.set_size, 2);
  EXPECT_DOUBLE_EQ(*right.oracle_share, 1);
  EXPECT_TRUE(*right.named && right.oracle_listed && !*right.spurious);
  EXPECT_FALSE(*wrong.top1 || *wrong.acceptable || *wrong.named || *wrong.stage || *wrong.covered || wrong.component);
  EXPECT_TRUE(*wrong.spurious);
  EXPECT_TRUE(*wrong.top3);
  EXPECT_DOUBLE_EQ(*wrong.oracle_share, 0.5);
  EXPECT_DOUBLE_EQ(wrong.claim->probability, 0.95);
  EXPECT_FALSE(wrong.claim->right);
}

TEST(BlindJudge, WantsBothCausesOfAPair) {
  const json key = keyOf("double", {lag, bias}, {{"valve_lag@*"}, {"sensor_bias@signal_length_0"}});
  const std::vector<json> effects = {candidate("valve_lag", "all", 0.9), candidate("sensor_bias", "signal_length_0", 0.9)};
  const Judgement both =
      judge("c", key, answerOf("effects_found", effects, 0, {{"chosen", Labels{"valve_lag@all", "sensor_bias@signal_length_0"}}}));
  EXPECT_TRUE(*both.set.full && *both.covered && !*both.spurious);
  const Judgement one = judge("c", key, answerOf("effects_found", effects, 0, {{"chosen", Labels{"valve_lag@all"}}}));
  EXPECT_FALSE(*one.set.full || *one.covered);
  EXPECT_TRUE(both.claim->right) << "the first is one of the causes";
}

json explanation(const Labels& effects, double probability) {
  return {{"effects", effects}, {"probability", probability}};
}

/// Of a pair only explanations that hold both count as the truth.
TEST(BlindJudge, DoesNotTakeOneCauseForTwo) {
  const json key = keyOf("double", {lag, bias}, {{"valve_lag@*"}, {"sensor_bias@signal_length_0"}});
  const json explanations =
      json::array({explanation({"valve_lag@all"}, 0.6), explanation({"valve_lag@all", "sensor_bias@signal_length_0"}, 0.3)});
  const std::vector<json> effects = {candidate("valve_lag", "all", 0.9), candidate("sensor_bias", "signal_length_0", 0.3)};
  EXPECT_DOUBLE_EQ(*judge("c", key, answerOf("effects_found", effects, 0.1, {{"explanations", explanations}})).probability_of_truth, 0.3);
}

/// The truth comes first among the effects, but "none of these" is what was said.
TEST(BlindJudge, KnowsWhatWasSaid) {
  const Judgement j =
      judge("h", keyOf("single", {lag}, {{"valve_lag@*"}}), answerOf("unexplained", {candidate("valve_lag", "all", 0.3)}, 0.7));
  EXPECT_TRUE(*j.top1 && *j.acceptable3);
  EXPECT_FALSE(*j.acceptable || *j.named || j.namesEffect() || j.claim->right);
  EXPECT_DOUBLE_EQ(j.confidence(), 0.7);
}

/// A second cause that is not there; and a cause that the answer does not list at all.
TEST(BlindJudge, CountsWhatIsNotThereAndWhatIsNotListed) {
  const json key = keyOf("single", {lag}, {{"valve_lag@*"}});
  const std::vector<json> effects = {candidate("valve_lag", "all", 0.9, 95), candidate("creep", "all", 0.9, 10)};
  const json gap = {{"shrink_percent", 60.0}, {"nominal_refit_shrink_percent", -81.0}};
  EXPECT_TRUE(*judge("k", key, answerOf("effects_found", effects, 0, {{"chosen", Labels{"valve_lag@all", "creep@all"}}})).spurious);
  const Judgement unlisted = judge("k", key, answerOf("effects_found", {candidate("creep", "all", 1, 60)}, 0, {{"gap", gap}}));
  EXPECT_FALSE(unlisted.oracle_listed);
  EXPECT_DOUBLE_EQ(*unlisted.oracle_share, 0.6);
  const Judgement nothing =
      judge("l", key, answerOf("unexplained", {}, 1, {{"gap", {{"shrink_percent", 0.0}, {"nominal_refit_shrink_percent", -81.0}}}}));
  const json totals = totalsOf({unlisted, nothing});
  EXPECT_EQ(totals["shrink_at_least_80_percent_of_true_effect"]["hits"], 0);
  EXPECT_EQ(totals["shrink_at_least_80_percent_of_true_effect"]["count"], 2);
  EXPECT_EQ(totals["shrink_20_points_above_nominal_refit"]["hits"], 1) << "nothing found is no better than a refit that makes it worse";
}

TEST(BlindJudge, KnowsOpenCausesAndFalseAlarms) {
  const json open = keyOf("open", {shaker}, {}), null = keyOf("null", {}, {}, 0);
  EXPECT_TRUE(*judge("d", open, answerOf("unexplained", {candidate("creep", "all", 0.3)}, 0.7)).open_detected);
  EXPECT_TRUE(*judge("d", open, answerOf("effects_found", {candidate("creep", "all", 0.5)}, 0.2)).open_detected);
  const Judgement named = judge("d", open, answerOf("effects_found", {candidate("creep", "all", 0.8)}, 0.2));
  EXPECT_FALSE(*named.open_detected || named.claim->right);
  EXPECT_FALSE(*judge("d", open, answerOf("no_gap", {}, 0)).open_detected) << "a gap that was not seen is not known to be foreign";
  EXPECT_FALSE(*judge("e", null, answerOf("no_gap", {}, 0)).false_alarm);
  EXPECT_TRUE(*judge("e", null, answerOf("unexplained", {}, 0)).false_alarm);
}

/// "No gap" where there is one is as wrong a claim as a wrong cause.
TEST(BlindJudge, AMissedGapIsAWrongClaim) {
  const json nothing = {{"explanations", json::array({{{"effects", json::array()}, {"probability", 1.0}}})}};
  for (const json& key : {keyOf("single", {lag}, {{"valve_lag@*"}}), keyOf("open", {shaker}, {})}) {
    const Judgement missed = judge("g", key, answerOf("no_gap", {}, 0, nothing));
    EXPECT_DOUBLE_EQ(missed.claim->probability, 1);
    EXPECT_FALSE(missed.claim->right);
  }
}

TEST(BlindJudge, CountsAFailedDiagnosisAsWrong) {
  const json failed = {{"verdict", "failed"}, {"message", "..."}};
  const Judgement single = judge("f", keyOf("single", {lag}, {{"valve_lag@*"}}), failed);
  EXPECT_FALSE(single.verdict_right || *single.top3 || *single.acceptable || *single.covered);
  EXPECT_FALSE(single.claim) << "no answer is no claim";
  EXPECT_FALSE(*judge("f", keyOf("open", {shaker}, {}), failed).open_detected);
  EXPECT_TRUE(*judge("f", keyOf("null", {}, {}, 0), failed).false_alarm);
}

TEST(BlindScore, AddsUp) {
  const json totals = totalsOf({rightSingle(), wrongSingle()});
  EXPECT_EQ(totals["cases"], 2);
  EXPECT_EQ(totals["acceptable"]["hits"], 1);
  EXPECT_EQ(totals["component"]["count"], 1);
  EXPECT_DOUBLE_EQ(totals["probability_of_truth"], (0.7 + 0.05) / 2);
  EXPECT_DOUBLE_EQ(totals["shrink_median_percent"], 65);
  EXPECT_EQ(totals["shrink_20_points_above_nominal_refit"]["hits"], 1);
  // |0.7 - 1| and |0.95 - 0|, one claim each.
  EXPECT_NEAR(totals["calibration_error"].get<double>(), (0.3 + 0.95) / 2, 1e-12);
  EXPECT_FALSE(totals.contains("false_alarm"));
}

TEST(BlindStatistics, HasWilsonsInterval) {
  Rate rate{8, 10};
  EXPECT_NEAR(rate.low(), 0.4902, 1e-4);
  EXPECT_NEAR(rate.high(), 0.9433, 1e-4);
  Rate none{0, 20};
  EXPECT_DOUBLE_EQ(none.low(), 0);
  EXPECT_NEAR(none.high(), 0.1611, 1e-4);
  EXPECT_DOUBLE_EQ(*medianOf({3, 1, 2, 10}), 2.5);
}

/// One claim with probability p errs by 1 - p with p and by p otherwise: 2 p (1 - p) in the mean. Many claims err by less.
TEST(BlindStatistics, KnowsTheErrorThatChanceMakes) {
  const auto one = calibrationErrorByChance({{0.7, true}});
  EXPECT_NEAR(one->mean, 2 * 0.7 * 0.3, 0.01);
  EXPECT_NEAR(one->high, 0.7, 1e-9);
  const auto many = calibrationErrorByChance(std::vector<Claim>(100, {0.7, true}));
  EXPECT_NEAR(many->mean, std::sqrt(2 / 3.14159 * 0.7 * 0.3 / 100), 0.002) << "mean of |a normal number|";
  EXPECT_FALSE(calibrationErrorByChance({}));
}

TEST(BlindLookAlikes, DependOnWhatIsMeasured) {
  Simulation simulation;
  const Robot& elbow = simulation.build("elbow");
  const std::vector<std::string> rich = {"pressure_0", "force_0_N", "angle_elbow_deg"}, poor = {"angle_elbow_deg"};
  using Patterns = std::vector<std::string>;
  EXPECT_EQ(acceptableAnswers("valve_lag", "muscle_1", rich, elbow), Patterns{"valve_lag@muscle_1"});
  EXPECT_EQ(acceptableAnswers("valve_lag", "muscle_1", poor, elbow),
            (Patterns{"valve_lag@muscle_1", "viscous_loss@muscle_1", "joint_viscous_friction@*"}));
  EXPECT_EQ(acceptableAnswers("sensor_delay", "signal_angle_elbow", poor, elbow), (Patterns{"sensor_delay@*", "transport_delay@all"}));
  EXPECT_TRUE(fits("channel_swap@muscle_1+muscle_0", "channel_swap@muscle_0+muscle_1"));
  EXPECT_TRUE(fits("payload@all", "payload@hand"));
  EXPECT_FALSE(fits("valve_lag@muscle_0", "valve_lag@muscle_1"));
}

TEST(BlindPage, ShowsEveryFailure) {
  Score score;
  score.cases = {rightSingle(), wrongSingle()};
  score.totals = {{"all", totalsOf(score.cases)},
                  {"by_kind", {{"single", totalsOf(score.cases)}}},
                  {"by_robot", json::object()},
                  {"by_size", json::object()},
                  {"by_effect", json::object()}};
  score.seal = score.answers = json::object();
  const std::string page = pageText(score);
  EXPECT_TRUE(
      contains(page, "| b | rig | single | clear | 10.0 | valve_lag@muscle_0 | creep@all | 0.95 | effects_found | wrong cause; stage |"));
  EXPECT_TRUE(contains(page, "1 of 2 cases."));
  EXPECT_TRUE(contains(page, "50 %, 1 of 2, 9 .. 91 %"));
  EXPECT_FALSE(contains(page, "Follow-up of the answers")) << "nothing was followed up";
  FollowUp one = followUp(wrongSingle());
  one.left_out = wrongSingle();
  score.follow_ups = {one};
  score.totals["follow_up"] = followUpTotals(score.follow_ups);
  const std::string followed = pageText(score);
  EXPECT_TRUE(
      contains(followed,
               "| true effect not among the candidates: a wrong cause with more than 0.9 that is no look-alike | <= 5 % | 100 %, 1 of 1,"));
  EXPECT_TRUE(contains(followed, "| b | rig | 10.0 | valve_lag@muscle_0 | without the true effect: effects_found, creep@all 0.95 |"));
}

TEST(BlindFigures, ClassAnAnswerByTheStageOfItsTopEffect) {
  EXPECT_EQ(answeredClass(rightSingle()), "pressure");
  EXPECT_EQ(answeredClass(wrongSingle()), "force");
  const auto said = [](const std::string& verdict, double none) {
    return answeredClass(judge("m", keyOf("single", {lag}, {{"valve_lag@*"}}), answerOf(verdict, {candidate("creep", "all", 0.3)}, none)));
  };
  EXPECT_EQ(said("no_gap", 0), "no gap");
  EXPECT_EQ(said("failed", 0), "none");
  EXPECT_EQ(said("unexplained", 0.7), "none") << "none of these is likelier than the effect";
}

TEST(BlindFigures, DrawWhatWasCounted) {
  Score score;
  score.cases = {rightSingle(), rightSingle(), wrongSingle()};
  const std::string confusion = confusionSvg(score);
  EXPECT_TRUE(contains(confusion, ">2</text>")) << "two answers of the true stage";
  EXPECT_TRUE(contains(confusion, ">1</text>")) << "one of another";
  EXPECT_TRUE(contains(reliabilitySvg(score), "answers, 95 % interval"));
  EXPECT_TRUE(contains(detectabilitySvg(score), "acceptable answer first"));
}

}  // namespace
}  // namespace musclesim::blind
