#include "odd_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "../../base/short_names.h"

namespace musclesim {

namespace {

constexpr double far_worse = 5;               ///< times as much as in any other recording, and noise floors at least
constexpr std::size_t fewest_recordings = 3;  ///< of two, nothing tells which is the odd one

using MeanSquares = std::map<int, std::map<int, std::pair<double, double>>>;  ///< by signal and recording: sum of squares, count

void add(const Comparison& comparison, const Eigen::VectorXd& residual, MeanSquares& sums) {
  if (residual.size() != comparison.size()) return;
  for (const Comparison::Block& block : comparison.blocks()) {
    if (!block.isReading()) continue;
    auto& [squares, count] = sums[block.signal][comparison.segments()[block.segment].recording];
    squares += comparison.meanSquare(block, residual) * static_cast<double>(block.count());
    count += static_cast<double>(block.count());
  }
}

}  // namespace

std::vector<std::string> oddRecordings(const Search& search, const HeldOut& held_out, const Eigen::VectorXd& fitted,
                                       const Eigen::VectorXd& after) {
  const Plant& plant = search.causes().plant();
  if (plant.recordings().size() < fewest_recordings) return {};
  MeanSquares sums;
  add(search.fitComparison(), fitted, sums);
  add(held_out.comparison, after, sums);
  std::vector<std::string> files;
  for (const Recording& recording : plant.recordings()) files.push_back(recording.file);
  const std::vector<std::string> names = shortNames(files);
  struct Odd {
    double times = 0, rms = 0;
    int signal = -1;
  };
  std::map<int, Odd> odd;  // by recording, the signal that stands out most
  for (const auto& [signal, of_recording] : sums) {
    const double noise = plant.signals()[static_cast<std::size_t>(signal)].sigma.value;
    for (const auto& [recording, sum] : of_recording) {
      const double rms = std::sqrt(sum.first / sum.second);
      double largest_other = noise;
      for (const auto& [other, other_sum] : of_recording)
        if (other != recording) largest_other = std::max(largest_other, std::sqrt(other_sum.first / other_sum.second));
      if (of_recording.size() < fewest_recordings || rms < far_worse * largest_other) continue;
      if (rms / largest_other > odd[recording].times) odd[recording] = {rms / largest_other, rms, signal};
    }
  }
  std::vector<std::string> sentences;
  for (const auto& [recording, worst] : odd) {
    const std::string& signal = plant.signals()[static_cast<std::size_t>(worst.signal)].name;
    sentences.push_back(fmt::format(
        "{} contradicts the other recordings: {} is left off by {:.3g} there (RMS), {:.0f} times as much as in any other. Something acts "
        "only there, or its columns, units or loads are not those of the others. Diagnose without it to see.",
        names[static_cast<std::size_t>(recording)], signal, worst.rms, worst.times));
  }
  return sentences;
}

}  // namespace musclesim
