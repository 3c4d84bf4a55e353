/// Prints how often the 95 % intervals of a fit of Eq. 1 contain the true constants, over 1000 seeded repeats, as a table in Markdown.
/// Usage: fit_coverage [repeats]
#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <string>

#include "laboratory/law_families.h"
#include "laboratory/planted.h"

using namespace musclesim;

namespace {

/// Counts for one constant.
struct Coverage {
  int inside = 0;
  double sum = 0, sum_of_squares = 0;
};

void study(NoiseOf noise_of, const BraunLengths& lengths, int repeat_count) {
  const BraunConstants planted;
  const std::map<std::string, double> truth = {{"a", planted.a}, {"b", planted.b}, {"c", planted.c_kgf}, {"l_min", 120}, {"l_max", 300}};
  const BraunForceLaw law(120, 300, planted);
  std::map<std::string, Coverage> coverage;
  int outlier_count = 0;
  for (int seed = 1; seed <= repeat_count; ++seed) {
    StaticPoints points = plantedPoints(law, 0.01, noise_of, static_cast<std::uint64_t>(seed));
    const Specimen specimen = specimenOf(points, std::nullopt);
    markOutliers(points, specimen);
    for (const auto& point : points.points) outlier_count += point.outlier;
    for (const auto& constant : fitLaw(*makeLawModel("braun", specimen, lengths), points).constants) {
      Coverage& counted = coverage[constant.name];
      const double value = truth.at(constant.name);
      counted.inside += constant.low && *constant.low <= value && value <= *constant.high;
      counted.sum += constant.value / value;
      counted.sum_of_squares += constant.value * constant.value / (value * value);
    }
  }
  for (const auto& [name, counted] : coverage) {
    const double mean = counted.sum / repeat_count, variance = counted.sum_of_squares / repeat_count - mean * mean;
    fmt::print("| {} | {} | {} | {:.1f} | {:.5f} | {:.2f} | {} |\n", noise_of == NoiseOf::largest ? "the largest force" : "each force",
               lengths.minimum_mm ? "held" : "fitted", name, 100.0 * counted.inside / repeat_count, mean,
               100 * std::sqrt(std::max(0.0, variance)), outlier_count);
  }
}

}  // namespace

int main(int argument_count, char** arguments) {
  const int repeat_count = argument_count > 1 ? std::atoi(arguments[1]) : 1000;
  fmt::print("Seeds 1 .. {}; 9 pressures times 11 lengths; noise of 1 %.\n\n", repeat_count);
  fmt::print("| noise of 1 % of | l_min | constant | intervals that hold the truth, % | mean of fit/truth | deviation, % | outliers |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (const NoiseOf noise_of : {NoiseOf::largest, NoiseOf::each})
    for (const bool is_held : {true, false}) study(noise_of, {is_held ? std::optional<double>(120) : std::nullopt, 300.0}, repeat_count);
}
