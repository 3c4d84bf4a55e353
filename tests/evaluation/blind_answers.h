/// Answers written by hand against keys written by hand.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/blind/follow_up_score.h"

namespace musclesim::blind::answers {

using nlohmann::json;

using Labels = std::vector<std::string>;
using Sets = std::vector<Labels>;

inline json keyOf(const std::string& kind, const std::vector<json>& effects, const Sets& acceptable, double gap = 10) {
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

inline const json lag = {{"id", "valve_lag"}, {"component", "muscle_0"}, {"stage", "pressure"}};
inline const json bias = {{"id", "sensor_bias"}, {"component", "signal_length_0"}, {"stage", "sensor"}};
inline const json shaker = {{"id", "foreign.shaker"}, {"component", "hand"}, {"stage", "body"}};

inline json answerOf(const std::string& verdict, const std::vector<json>& effects, double none, const json& more = json::object()) {
  json answer = {{"verdict", verdict}, {"effects", effects}, {"none_of_these", none}};
  answer.update(more);
  return answer;
}

inline json candidate(const std::string& id, const std::string& component, double probability, double reduction_percent = 0) {
  return {{"id", id}, {"component", component}, {"probability", probability}, {"shrink_percent", reduction_percent}};
}

/// Right, with 0.7 on the truth and 0.2 on an acceptable look-alike.
inline Judgement rightSingle() {
  return judge("a", keyOf("single", {lag}, {{"valve_lag@*", "viscous_loss@*"}}),
               answerOf("effects_found",
                        {candidate("valve_lag", "all", 0.7, 90), candidate("viscous_loss", "all", 0.2), candidate("creep", "all", 0.1)}, 0,
                        {{"ambiguity_set", Labels{"valve_lag@all", "viscous_loss@all"}},
                         {"chosen", Labels{"valve_lag@all"}},
                         {"where", json::array({json{{"stage", "pressure"}}})},
                         {"gap", {{"shrink_percent", 90.0}, {"nominal_refit_shrink_percent", 60.0}}}}));
}

/// A wrong name with 0.95, the truth second with 0.05 and a shrink of 80 %.
inline Judgement wrongSingle() {
  return judge("b", keyOf("single", {lag}, {{"valve_lag@*"}}),
               answerOf("effects_found", {candidate("creep", "all", 0.95, 40), candidate("valve_lag", "muscle_0", 0.05, 80)}, 0,
                        {{"ambiguity_set", Labels{"creep@all"}},
                         {"chosen", Labels{"creep@all"}},
                         {"where", json::array({json{{"stage", "force"}}})},
                         {"gap", {{"shrink_percent", 40.0}, {"nominal_refit_shrink_percent", 30.0}}}}));
}

inline FollowUp followUp(const Judgement& answer) {
  return {answer, {}, {}, {}};
}

}  // namespace musclesim::blind::answers
