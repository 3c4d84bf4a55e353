/// Table and figure of `musclesim bench`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace musclesim::command_line {

struct BenchRun {
  int muscle_count = 0, repeat_count = 0, substeps = 0, contact_count = 0;
  double ratio = 0;   ///< CPU time over simulated time
  double spread = 1;  ///< largest over smallest ratio of the repeats
  double simulated_s = 0, gap_mm = 0;
  bool cut_short = false, diverged = false;
};

struct BenchCurve {
  std::string name;
  std::vector<BenchRun> runs;
};

/// The exponent b of r = a n^b, fitted to the points with at least `first_count` muscles by least squares of the logarithms; NaN for fewer
/// than two points.
double fittedExponent(const BenchCurve& curve, int first_count);

std::string benchTable(const std::vector<BenchCurve>& curves, double duration_s, double shortest_cpu_s, double time_limit_s);
enum class BenchReference { none, paper };
/// The figure: r over n, both axes logarithmic, with the paper's curve or without.
std::string benchFigure(const std::vector<BenchCurve>& curves, BenchReference reference = BenchReference::paper);
nlohmann::json benchJson(const std::vector<BenchCurve>& curves);

}  // namespace musclesim::command_line
