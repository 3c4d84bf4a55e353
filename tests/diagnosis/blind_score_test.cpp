// Answers written by hand against keys written by hand; the numbers were computed on paper.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "diagnosis/blind/judge.h"
#include "diagnosis/blind/look_alikes.h"
#include "diagnosis/blind/page.h"
#include "diagnosis/blind/score.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim::blind {
namespace {

using nlohmann::json;

using Labels = std::vector<std::string>;
using Sets = std::vector<Labels>;

json keyOf(const std::string& kind, const std::vector<json>& effects, const Sets& acceptable, double gap = 10) {
  json stages = json::array();
  for (const json& effect : effects) stages.push_back(effect["stage"]);
  return {{"robot", "rig"},
          {"kind", kind},
          {"size", kind == "null" ? "none" : "clear"},
          {"verdict", kind == "null"   ? "no_gap"
                      : kind == "open" ? "unexplained"
                                       : "effects_found"},
          {"effects", effects},
          {"acceptable", acceptable},
          {"stages", stages},
          {"gap_over_noise", gap}};
}

const json lag = {{"id", "valve_lag"}, {"component", "muscle_0"}, {"stage", "pressure"}};
const json bias = {{"id", "sensor_bias"}, {"component", "signal_length_0"}, {"stage", "sensor"}};
const json shaker = {{"id", "foreign.shaker"}, {"component", "hand"}, {"stage", "body"}};

json answerOf(const std::string& verdict, const std::vector<json>& effects, double none, const json& more = json::object()) {
  json answer = {{"verdict", verdict}, {"effects", effects}, {"none_of_these", none}};
  answer.update(more);
  return answer;
}

json candidate(const std::string& id, const std::string& component, double probability, double shrink_percent = 0) {
  return {{"id", id}, {"component", component}, {"probability", probability}, {"shrink_percent", shrink_percent}};
}

/// Right, with 0.7 on the truth and 0.2 on an acceptable look-alike.
Judgement rightSingle() {
  return judge("a", keyOf("single", {lag}, {{"valve_lag@*", "viscous_loss@*"}}),
               answerOf("effects_found",
                        {candidate("valve_lag", "all", 0.7, 90), candidate("viscous_loss", "all", 0.2), candidate("creep", "all", 0.1)}, 0,
                        {{"ambiguity_set", Labels{"valve_lag@all", "viscous_loss@all"}},
                         {"chosen", Labels{"valve_lag@all"}},
                         {"where", json::array({json{{"stage", "pressure"}}})},
                         {"gap", {{"shrink_percent", 90.0}, {"nominal_refit_shrink_percent", 60.0}}}}));
}

/// A wrong name with 0.95, the truth second with 0.05 and a shrink of 80 %.
Judgement wrongSingle() {
  return judge("b", keyOf("single", {lag}, {{"valve_lag@*"}}),
               answerOf("effects_found", {candidate("creep", "all", 0.95, 40), candidate("valve_lag", "muscle_0", 0.05, 80)}, 0,
                        {{"ambiguity_set", Labels{"creep@all"}},
                         {"chosen", Labels{"creep@all"}},
                         {"where", json::array({json{{"stage", "force"}}})},
                         {"gap", {{"shrink_percent", 40.0}, {"nominal_refit_shrink_percent", 30.0}}}}));
}

TEST(BlindJudge, CountsARightAndAWrongAnswer) {
  const Judgement right = rightSingle(), wrong = wrongSingle();
  EXPECT_TRUE(*right.top1 && *right.acceptable && *right.component && *right.stage && *right.covered && right.verdict_right);
  EXPECT_DOUBLE_EQ(*right.probability_of_truth, 0.7);
  EXPECT_DOUBLE_EQ(*right.probability_of_acceptable, 0.9);
  EXPECT_DOUBLE_EQ(*right.set_size, 2);
  EXPECT_DOUBLE_EQ(*right.oracle_share, 1);
  EXPECT_FALSE(*wrong.top1 || *wrong.acceptable || *wrong.stage || *wrong.covered || wrong.component);
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
  EXPECT_TRUE(*both.pair && *both.covered);
  const Judgement one = judge("c", key, answerOf("effects_found", effects, 0, {{"chosen", Labels{"valve_lag@all"}}}));
  EXPECT_FALSE(*one.pair || *one.covered);
  EXPECT_FALSE(both.claim);
}

TEST(BlindJudge, KnowsOpenCausesAndFalseAlarms) {
  const json open = keyOf("open", {shaker}, {}), null = keyOf("null", {}, {}, 0);
  EXPECT_TRUE(*judge("d", open, answerOf("unexplained", {candidate("creep", "all", 0.3)}, 0.7)).open_detected);
  EXPECT_TRUE(*judge("d", open, answerOf("effects_found", {candidate("creep", "all", 0.5)}, 0.2)).open_detected);
  const Judgement named = judge("d", open, answerOf("effects_found", {candidate("creep", "all", 0.8)}, 0.2));
  EXPECT_FALSE(*named.open_detected || named.claim->right);
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
  EXPECT_TRUE(contains(page, "| b | rig | single | clear | 10.0 | valve_lag@muscle_0 | creep@all | 0.95 | effects_found | wrong cause |"));
  EXPECT_TRUE(contains(page, "1 of 2 cases."));
  EXPECT_TRUE(contains(page, "50 %, 1 of 2, 9 .. 91 %"));
}

}  // namespace
}  // namespace musclesim::blind
