#include "benchmark.h"

#include <fmt/format.h>

namespace musclesim::blind {

using nlohmann::json;

namespace {

/// How a measure is found and written.
struct Measure {
  const char* words;
  const char* group;  ///< member of Score::totals, or of its by_kind
  const char* name;   ///< member of the group: a rate or a number
  double demand, aim;
  bool most = false;  ///< the bounds are upper ones
};

/// The bounds were fixed before the search over sets of causes was built.
constexpr Measure measures[] = {
    {"full set, two causes", "double", "full_set", 0.70, 0.85},
    {"full set, three causes", "triple", "full_set", 0.50, 0.70},
    {"full set, four or five causes", "quadruple", "full_set", 0.30, 0.50},
    {"demanded effects found, several causes", "several", "demanded_found", 0.80, 0.90},
    {"wrong effects per plant, several causes", "several", "wrong_effects", 0.25, 0.12, true},
    {"acceptable effect first, one cause", "single", "acceptable", 0.88, 0.92},
    {"mean probability of the true set, two causes", "double", "probability_of_truth", 0.60, 0.75},
    {"mean probability of the true set, several causes", "several", "probability_of_truth", 0.60, 0.75},
    {"calibration error of the effects' probabilities, all", "all", "inclusion_calibration_error", 0.04, 0.03, true},
    {"calibration error of \"that is all\", all", "all", "complete_calibration_error", 0.06, 0.04, true},
    {"true set among the ambiguity sets, several causes", "several", "covered", 0.95, 0.97},
    {"mean number of ambiguity sets, several causes", "several", "set_size", 4, 3, true},
    {"false alarms, no cause", "all", "false_alarm", 0.05, 0.02, true},
    {"unknown cause told, alone or beside known ones", "all", "unknown_told", 0.85, 0.95},
    {"gap reduction at least 80 % of the true effects'", "all", "shrink_at_least_80_percent_of_true_effect", 0.85, 0.93}};

const json& groupOf(const json& totals, const std::string& name) {
  static const json none = json::object();
  if (totals.contains(name)) return totals[name];
  return totals.contains("by_kind") && totals["by_kind"].contains(name) ? totals["by_kind"][name] : none;
}

BenchmarkRow rowOf(const Measure& measure, const json& totals) {
  const json& group = groupOf(totals, measure.group);
  const auto bound = [&](double value) { return fmt::format("{} {}", measure.most ? "<=" : ">=", value); };
  BenchmarkRow row{measure.words, "-", bound(measure.demand), bound(measure.aim)};
  if (!group.contains(measure.name)) return row;
  const json& found = group[measure.name];
  const double value = found.is_object() ? found["value"].get<double>() : found.get<double>();
  row.value = found.is_object() ? fmt::format("{:.2f} ({} of {}, {:.2f} .. {:.2f})", value, found["hits"].get<int>(),
                                              found["count"].get<int>(), found["low"].get<double>(), found["high"].get<double>())
                                : fmt::format("{:.3f}", value);
  row.met = measure.most ? value <= measure.demand : value >= measure.demand;
  return row;
}

}  // namespace

std::vector<BenchmarkRow> benchmarkRows(const json& totals) {
  std::vector<BenchmarkRow> rows;
  for (const Measure& measure : measures) rows.push_back(rowOf(measure, totals));
  return rows;
}

std::string benchmarkTable(const json& totals) {
  std::string text = "| measure | value | demand | aim |\n|---|---|---|---|\n";
  for (const BenchmarkRow& row : benchmarkRows(totals))
    text += fmt::format("| {} | {} | {}{} | {} |\n", row.measure, row.value, row.demand, row.met || row.value == "-" ? "" : " (missed)",
                        row.aim);
  return text;
}

}  // namespace musclesim::blind
