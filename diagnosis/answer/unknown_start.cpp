#include "unknown_start.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "../../base/short_names.h"
#include "../data/data_checks.h"

namespace musclesim {

namespace {

constexpr double much_worse = 3;  ///< times, and noise floors at least: laws that are a little off leave about as much everywhere
constexpr double mostly = 10;     ///< times as much motion: nearly all of what such a recording tells
constexpr int fewest_parts = 4;   ///< seconds that a recording lasts
constexpr int largest_share = 3;  ///< at most one third of a recording is left out

/// Of the rows of one second.
struct Part {
  double count = 0, residual_squares = 0, sum = 0, squares = 0;

  double residual() const { return residual_squares / count; }
  double variance() const { return std::max(0.0, squares / count - std::pow(sum / count, 2)); }
};

struct Start {
  int seconds = 0;      ///< at the beginning, in which a signal is much farther off than in the second half of the recording; 0: in none
  double times = 0;     ///< as far off in the first one
  bool counts = false;  ///< the recording is too short to miss it, or the signal moves much more then than in the second half
};

Start startOf(const std::map<int, Part>& parts, double sigma) {
  const int last = parts.rbegin()->first;
  if (last + 1 < fewest_parts) return {.counts = true};
  double residual = 0, variance = 0, count = 0;
  for (const auto& [second, part] : parts) {
    if (2 * second < last + 1) continue;
    residual += part.residual_squares, variance += part.count * part.variance(), count += part.count;
  }
  const double noise = sigma * sigma, most = much_worse * much_worse;
  const double later = std::max(residual / count, noise), motion_later = variance / count + noise;
  Start start;
  start.counts = parts.begin()->first == 0 && parts.begin()->second.variance() + noise > mostly * mostly * motion_later;
  for (const auto& [second, part] : parts) {
    const bool is_far_off = part.residual() > most * later && part.residual() * motion_later > most * later * (part.variance() + noise);
    if (second != start.seconds || part.count < fewest_compared_rows || !is_far_off) break;
    if (second == 0) start.times = std::sqrt(part.residual() / later);
    ++start.seconds;
  }
  start.seconds = std::min(start.seconds, (last + 1) / largest_share);
  return start;
}

}  // namespace

UnknownStarts unknownStarts(const Search& search, const HeldOut& held_out, const Eigen::VectorXd& fitted, const Eigen::VectorXd& after) {
  const Plant& plant = search.causes().plant();
  std::map<std::pair<int, int>, std::map<int, Part>> parts;  // by recording and signal, by second
  const auto add = [&](const Comparison& comparison, const Eigen::VectorXd& residual) {
    if (residual.size() != comparison.size()) return;
    for (const Comparison::Block& block : comparison.blocks()) {
      const int recording = comparison.segments()[block.segment].recording;
      if (!block.isReading() || !plant.beginsUnknown(recording)) continue;
      const std::vector<double>& time_s = plant.recordings()[static_cast<std::size_t>(recording)].time_s;
      for (Eigen::Index i = 0; i < block.count(); ++i) {
        const auto row = static_cast<std::size_t>(block.rows[static_cast<std::size_t>(i)]);
        const double reading = plant.measured(recording, block.signal)[row], off = residual[block.first + i];
        Part& part = parts[{recording, block.signal}][static_cast<int>((time_s[row] - time_s.front()) / forgotten_after_s)];
        part.count += 1, part.residual_squares += off * off, part.sum += reading, part.squares += reading * reading;
      }
    }
  };
  add(search.fitComparison(), fitted);
  add(held_out.comparison, after);

  UnknownStarts starts;
  std::map<int, bool> others;  // by recording, whether its beginning counts
  double most = 0;
  int worst = 0;  // the signal that is farthest off
  for (const auto& [place, seconds] : parts) {
    const auto& [recording, signal] = place;
    const Start start = startOf(seconds, plant.signals()[static_cast<std::size_t>(signal)].sigma.value);
    others[recording] = others[recording] || start.counts;
    if (start.seconds == 0) continue;
    starts.seconds[recording] = std::max(starts.seconds[recording], start.seconds * forgotten_after_s);
    if (start.times > most) most = start.times, worst = signal;
  }
  if (starts.seconds.empty()) return {};
  std::vector<std::string> files, names;
  for (const Recording& recording : plant.recordings()) files.push_back(recording.file);
  const std::vector<std::string> short_names = shortNames(files);
  for (const auto& [recording, seconds] : starts.seconds) names.push_back(short_names[static_cast<std::size_t>(recording)]);
  // One logger made them all.
  for (const auto& [recording, its_start_counts] : others)
    if (!its_start_counts) starts.seconds.emplace(recording, forgotten_after_s);
  starts.sentence = fmt::format(
      "{} {} in another state than the model, which begins at rest and without a history: probably the machine had been moving before. "
      "With what had been found, {} was up to {:.0f} times as far off in the first {:g} s as in the second half. The readings at the "
      "beginning were left out, and all was fitted again (--skip-start 0 keeps them).",
      fmt::join(names, ", "), names.size() > 1 ? "begin" : "begins", plant.signals()[static_cast<std::size_t>(worst)].name, most,
      forgotten_after_s);
  return starts;
}

}  // namespace musclesim
