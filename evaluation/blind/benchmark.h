/// The benchmark of plants with several causes: what an answer must reach.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace musclesim::blind {

/// One measure with its value and the bounds that it should keep.
struct BenchmarkRow {
  std::string measure, value, demand, aim;  ///< as text; value "-" if no case says it
  bool met = false;                         ///< the demand
};

/// The rows of the benchmark from Score::totals.
std::vector<BenchmarkRow> benchmarkRows(const nlohmann::json& totals);
/// The rows as a Markdown table; a demand that is not met is marked.
std::string benchmarkTable(const nlohmann::json& totals);

}  // namespace musclesim::blind
