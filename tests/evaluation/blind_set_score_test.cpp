// Answers with several causes, written by hand; the numbers were computed on paper.
#include <gtest/gtest.h>

#include "blind_answers.h"
#include "evaluation/blind/benchmark.h"
#include "evaluation/blind/score.h"
#include "support/support.h"

namespace musclesim::blind {
namespace {

using namespace answers;

const json creep = {{"id", "creep"}, {"component", "muscle_0"}, {"stage", "force"}};
const Sets patterns = {{"valve_lag@*", "viscous_loss@*"}, {"sensor_bias@signal_length_0"}, {"creep@*"}};
const char *const lag_label = "valve_lag@all", *const bias_label = "sensor_bias@signal_length_0", *const creep_label = "creep@all";

json withDemand(json effect, bool demanded) {
  effect["demanded"] = demanded;
  return effect;
}

/// A lag, a bias, and creep that is too small to be demanded.
json threeCauses() {
  return keyOf("triple", {withDemand(lag, true), withDemand(bias, true), withDemand(creep, false)}, patterns);
}

json chosen(const Labels& labels, json more = json::object()) {
  more["chosen"] = labels;
  return answerOf("effects_found", {}, 0, more);
}

TEST(BlindSet, DemandsOnlyWhatTheKeyDemands) {
  const SetJudgement both = judgeSet(threeCauses(), chosen({lag_label, bias_label}));
  EXPECT_EQ(both.demanded, 2);
  EXPECT_EQ(both.found, 2);
  EXPECT_TRUE(*both.full);
  const SetJudgement optional_too = judgeSet(threeCauses(), chosen({lag_label, bias_label, creep_label}));
  EXPECT_EQ(optional_too.wrong, 0);
  EXPECT_TRUE(*optional_too.full);
}

TEST(BlindSet, CountsFoundAndWrongEffects) {
  const SetJudgement part = judgeSet(threeCauses(), chosen({lag_label, "payload@hand", "leak@all"}));
  EXPECT_EQ(part.found, 1);
  EXPECT_EQ(part.wrong, 2);
  EXPECT_FALSE(*part.full);
  EXPECT_TRUE(*judgeSet(threeCauses(), chosen({"viscous_loss@all", bias_label})).full) << "a look-alike";
  EXPECT_FALSE(*judgeSet(threeCauses(), chosen({lag_label, bias_label, "leak@all"})).full) << "one too many";
  EXPECT_EQ(judgeSet(threeCauses(), {{"verdict", "failed"}}).found, 0);
}

TEST(BlindSet, SumsTheProbabilityOfFullSets) {
  const json explanations = json::array({{{"effects", Labels{lag_label, bias_label}}, {"probability", 0.4}},
                                         {{"effects", Labels{lag_label, bias_label, creep_label}}, {"probability", 0.2}},
                                         {{"effects", Labels{lag_label, bias_label, "leak@all"}}, {"probability", 0.1}},
                                         {{"effects", Labels{lag_label}}, {"probability", 0.3}}});
  EXPECT_NEAR(*judgeSet(threeCauses(), chosen({lag_label}, {{"explanations", explanations}})).probability, 0.6, 1e-12);
  EXPECT_EQ(*judgeSet(threeCauses(), chosen({lag_label})).probability, 0) << "explanations were not given";
}

TEST(BlindSet, LooksForTheTrueSetAmongTheAmbiguousOnes) {
  const json sets = {{"ambiguity_sets", Sets{{lag_label, bias_label}, {"leak@all"}, {"payload@hand"}}}};
  const SetJudgement torn = judgeSet(threeCauses(), chosen({"leak@all"}, sets));
  EXPECT_TRUE(*torn.covered);
  EXPECT_EQ(*torn.class_size, 3);
  EXPECT_FALSE(*judgeSet(threeCauses(), chosen({lag_label}, {{"ambiguity_set", Labels{lag_label, bias_label}}})).covered)
      << "one effect of a list is no set";
}

/// valve_lag and its look-alike are one claim; creep is optional and makes none; the bias is not listed.
TEST(BlindSet, MakesOneClaimPerCause) {
  const json answer = answerOf("effects_found",
                               {candidate("valve_lag", "all", 0.5), candidate("viscous_loss", "all", 0.25), candidate("creep", "all", 0.2),
                                candidate("leak", "all", 0.1)},
                               0);
  const std::vector<Claim> claims = judgeSet(threeCauses(), answer).inclusion;
  ASSERT_EQ(claims.size(), 3u);
  EXPECT_EQ(claims[0].probability, 0.1);
  EXPECT_FALSE(claims[0].right);
  EXPECT_EQ(claims[1].probability, 0.75);
  EXPECT_TRUE(claims[1].right);
  EXPECT_EQ(claims[2].probability, 0);
  EXPECT_TRUE(claims[2].right);
}

TEST(BlindSet, KnowsWhetherAnUnknownCauseWasTold) {
  const json mixed = keyOf("mixed", {lag, shaker}, {{"valve_lag@*"}}),
             known = keyOf("double", {lag, bias}, {{"valve_lag@*"}, {bias_label}});
  const json weak = keyOf("mixed", {lag, withDemand(shaker, false)}, {{"valve_lag@*"}});
  const json told = chosen({lag_label}, {{"remainder", {{"significant", true}, {"probability", 0.8}}}}), silent = chosen({lag_label});
  EXPECT_TRUE(*judgeSet(mixed, told).unknown_told);
  EXPECT_FALSE(*judgeSet(mixed, silent).unknown_told);
  EXPECT_TRUE(*judgeSet(mixed, answerOf("unexplained", {}, 1)).unknown_told);
  EXPECT_FALSE(judgeSet(weak, silent).unknown_told) << "too small to be told";
  EXPECT_TRUE(*judgeSet(known, told).unknown_claimed);
  EXPECT_FALSE(*judgeSet(known, silent).unknown_claimed);
  EXPECT_TRUE(*judgeSet(mixed, silent).full) << "the known cause is all that can be named";
  EXPECT_NEAR(judgeSet(mixed, told).complete->probability, 0.2, 1e-12);
  EXPECT_FALSE(judgeSet(mixed, told).complete->right);
  EXPECT_FALSE(judgeSet(mixed, silent).complete) << "not given";
}

TEST(BlindSet, IsNoFalseAlarmToCorrectNumbers) {
  const json null = keyOf("null", {}, {}, 4);
  EXPECT_FALSE(*judge("a", null, chosen({})).false_alarm);
  EXPECT_TRUE(judge("a", null, chosen({})).verdict_right);
  EXPECT_TRUE(*judge("b", null, chosen({lag_label})).false_alarm);
  EXPECT_TRUE(*judge("c", null, answerOf("effects_found", {candidate("creep", "all", 0.9)}, 0)).false_alarm);
}

TEST(BlindSet, ComparesTheReductionWithThatOfTheTrueLaws) {
  json key = threeCauses();
  const auto share = [&](double oracle_percent) {
    key["oracle_shrink_percent"] = oracle_percent;
    return judge("a", key, chosen({lag_label}, {{"gap", {{"shrink_percent", 60.0}}}})).oracle_share;
  };
  EXPECT_DOUBLE_EQ(*share(80), 0.75);
  EXPECT_FALSE(share(10)) << "the gap has other reasons";
}

/// An effect that the key does not demand is no failure of a plant that has no other one.
TEST(BlindSet, AsksNothingWhereNothingIsDemanded) {
  const Judgement j = judge("a", keyOf("single", {withDemand(lag, false)}, {{"valve_lag@*"}}), answerOf("no_gap", {}, 0));
  EXPECT_FALSE(j.acceptable || j.set.full || j.covered);
}

TEST(BlindBenchmark, PrintsValuesBesideTheirBounds) {
  const std::vector<Judgement> cases = {judge("a", threeCauses(), chosen({lag_label, bias_label})),
                                        judge("b", threeCauses(), chosen({lag_label, "leak@all"}))};
  const json totals = {{"all", totalsOf(cases)}, {"several", totalsOf(cases)}, {"by_kind", {{"triple", totalsOf(cases)}}}};
  const std::string table = benchmarkTable(totals);
  EXPECT_TRUE(contains(table, "| full set, three causes | 0.50 (1 of 2,"));
  EXPECT_TRUE(contains(table, "| demanded effects found, several causes | 0.75 (3 of 4,"));
  EXPECT_TRUE(contains(table, "| wrong effects per plant, several causes | 0.500 | <= 0.25 (missed) | <= 0.12 |"));
  EXPECT_TRUE(contains(table, "| full set, two causes | - | >= 0.7 | >= 0.85 |"));
  for (const BenchmarkRow& row : benchmarkRows(totals))
    if (row.measure == "full set, three causes") {
      EXPECT_TRUE(row.met);
    }
}

}  // namespace
}  // namespace musclesim::blind
