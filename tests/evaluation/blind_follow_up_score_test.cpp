// What comes of answers, counted; the numbers were computed on paper.
#include <gtest/gtest.h>

#include "blind_answers.h"
#include "evaluation/blind/follow_up_score.h"

namespace musclesim::blind {
namespace {

using namespace answers;

TEST(BlindFollowUp, TellsWhatAnAnswerTurnsToWithoutTheTruth) {
  const json key = keyOf("single", {lag}, {{"valve_lag@*", "viscous_loss@*"}});
  const Judgement with_truth =
      judge("m", key,
            answerOf("effects_found", {candidate("valve_lag", "all", 0.8)}, 0, {{"ambiguity_set", Labels{"valve_lag@all", "leak@all"}}}));
  auto turns = [&](const std::string& verdict, const std::vector<json>& effects, double none) {
    return withoutTruth(judge("m", key, answerOf(verdict, effects, none)), with_truth);
  };
  EXPECT_EQ(turns("failed", {}, 0), WithoutTruth::failed);
  EXPECT_EQ(turns("effects_found", {candidate("creep", "all", 0.91)}, 0), WithoutTruth::confidently_wrong);
  EXPECT_EQ(turns("effects_found", {candidate("viscous_loss", "all", 0.95)}, 0), WithoutTruth::look_alike);
  EXPECT_EQ(turns("effects_found", {candidate("leak", "all", 0.95)}, 0), WithoutTruth::named_before);
  EXPECT_EQ(turns("effects_found", {candidate("leak", "muscle_0", 0.95)}, 0), WithoutTruth::confidently_wrong);
  EXPECT_EQ(turns("effects_found", {candidate("joint_viscous_friction", "joint_elbow", 0.95)}, 0), WithoutTruth::class_mate);
  EXPECT_EQ(turns("effects_found", {candidate("joint_viscous_friction", "joint_elbow", 0.6)}, 0.4), WithoutTruth::unsure);
  EXPECT_EQ(turns("effects_found", {candidate("creep", "all", 0.6)}, 0.4), WithoutTruth::unsure);
  EXPECT_EQ(turns("effects_found", {candidate("creep", "all", 0.4)}, 0.5), WithoutTruth::unexplained);
  EXPECT_EQ(turns("unexplained", {candidate("creep", "all", 0.95)}, 0), WithoutTruth::unexplained);
}

TEST(BlindFollowUp, WantsTheTruthToBeTheSingleBest) {
  const json key = keyOf("single", {lag}, {{"valve_lag@*"}});
  auto told = [&](const std::vector<json>& effects, double none, const Labels& set) {
    return judge("n", key, answerOf("effects_found", effects, none, {{"ambiguity_set", set}}));
  };
  const std::vector<json> sure = {candidate("valve_lag", "all", 0.9)},
                          torn = {candidate("creep", "all", 0.5), candidate("valve_lag", "all", 0.4)};
  FollowUp solved = followUp(told(torn, 0.1, {"creep@all", "valve_lag@all"})), unsolved = solved, outside = solved, unanswered = solved;
  solved.experiment = told(sure, 0.1, {"valve_lag@all"});
  unsolved.experiment = told({candidate("valve_lag", "all", 0.3)}, 0.6, {"valve_lag@all"});
  outside.answer = told({candidate("creep", "all", 0.6), candidate("leak", "all", 0.3)}, 0.1, {"creep@all", "leak@all"});
  outside.experiment = told({candidate("valve_lag", "all", 0.6), candidate("leak", "all", 0.3)}, 0.1, {"valve_lag@all", "leak@all"});
  unanswered.experiment = judge("n", key, {{"verdict", "failed"}, {"message", "no schedule was proposed"}});
  EXPECT_TRUE(isAmbiguous(solved.answer) && isAmbiguous(outside.answer));
  EXPECT_FALSE(isAmbiguous(told(sure, 0.1, {"valve_lag@all"})));
  const json totals = followUpTotals({solved, unsolved, outside, unanswered});
  EXPECT_EQ(totals["experiment_truth_first_before"]["hits"], 0);
  EXPECT_EQ(totals["experiment_truth_first"]["hits"], 2);
  EXPECT_EQ(totals["experiment_truth_first"]["count"], 4);
  EXPECT_EQ(totals["experiment_truth_first_where_covered"]["count"], 3);
  EXPECT_EQ(totals["experiment_alone"]["hits"], 1);
  EXPECT_TRUE(missesOf(solved).empty());
  EXPECT_EQ(missesOf(unanswered), Labels{"after the proposed schedule: failed: no schedule was proposed"});
}

TEST(BlindFollowUp, AsksWhetherAnIntervalSaysAnything) {
  FollowUp narrow = followUp(rightSingle()), wide = narrow, diverged = narrow, missed = narrow, without = narrow;
  narrow.fresh = FreshReduction{91, 90, std::pair(88.0, 92.0), false};
  wide.fresh = FreshReduction{-500, 90, std::pair(-1000.0, 99.0), false};
  diverged.fresh = FreshReduction{90, 90, std::pair(88.0, 92.0), true};
  missed.fresh = FreshReduction{80, 90, std::pair(88.0, 92.0), false};
  without.fresh = FreshReduction{80, 90, {}, false};  // claims nothing
  const json totals = followUpTotals({narrow, wide, diverged, missed, without});
  EXPECT_EQ(totals["fresh_within"]["hits"], 2);
  EXPECT_EQ(totals["fresh_narrow"]["hits"], 3);
  EXPECT_EQ(totals["fresh_within_narrow"]["hits"], 1);
  EXPECT_DOUBLE_EQ(totals["fresh_median_width_points"], 4);
  EXPECT_DOUBLE_EQ(totals["fresh_median_difference_points"], 10);
  EXPECT_EQ(totals["fresh_within"]["count"], 4);
  EXPECT_TRUE(missesOf(without).empty());
  EXPECT_EQ(missesOf(missed), Labels{"on a fresh recording 80.0 % instead of 90.0 (88.0 to 92.0)"});
  EXPECT_TRUE(followUpTotals({}).empty());
}

}  // namespace
}  // namespace musclesim::blind
