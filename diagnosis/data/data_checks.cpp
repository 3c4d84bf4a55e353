#include "data_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double least_signal_change = 0.02;
constexpr double usual_steps = 10;  ///< a dropout is longer than this number of usual steps

std::vector<std::string> dropoutNotes(const Recording& recording) {
  std::vector<std::string> notes;
  for (const Dropout& dropout : dropoutsOf(recording))
    notes.push_back(fmt::format(
        "{}: no rows between {:.3f} and {:.3f} s; the simulation runs through with the command held{}", recording.file,
        recording.time_s[dropout.next_row - 1], recording.time_s[dropout.next_row],
        dropout.changes_commands
            ? fmt::format(", and since it is another one after that, the readings of the next {:g} s are left out", forgotten_after_s)
            : ""));
  return notes;
}

}  // namespace

double medianSize(const std::vector<double>& values) {
  std::vector<double> sizes;
  for (const double value : values)
    if (std::isfinite(value)) sizes.push_back(std::abs(value));
  if (sizes.empty()) return 0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  return *middle;
}

std::vector<Dropout> dropoutsOf(const Recording& recording) {
  std::vector<double> steps;
  for (std::size_t row = 1; row < recording.time_s.size(); ++row) steps.push_back(recording.time_s[row] - recording.time_s[row - 1]);
  const double usual_s = medianSize(steps);
  std::vector<Dropout> dropouts;
  for (std::size_t row = 1; row < recording.time_s.size(); ++row) {
    if (steps[row - 1] <= usual_steps * usual_s) continue;
    const auto any = [&](const auto& holds) { return std::ranges::any_of(recording.signals, holds); };
    const bool changes =
        any([&](const Signal& signal) { return signal.name.starts_with("command_") && signal.values[row] != signal.values[row - 1]; });
    const bool is_of_machine =
        any([&](const Signal& signal) { return !signal.name.starts_with("command_") && std::isfinite(signal.values[row - 1]); });
    dropouts.push_back({row, changes && is_of_machine});
  }
  return dropouts;
}

bool commandsMove(const std::vector<Recording>& recordings) {
  for (const Recording& recording : recordings)
    for (const Signal& signal : recording.signals) {
      if (!signal.name.starts_with("command_")) continue;
      const auto [least, largest] = std::ranges::minmax_element(signal.values);
      if (*largest - *least > least_signal_change) return true;
    }
  return false;
}

int firstChange(const Recording& recording) {
  auto first = static_cast<std::ptrdiff_t>(recording.time_s.size());
  for (const Signal& signal : recording.signals) {
    if (!signal.name.starts_with("command_")) continue;
    const auto changed =
        std::ranges::find_if(signal.values, [&](double value) { return std::abs(value - signal.values.front()) > least_signal_change; });
    first = std::min(first, changed - signal.values.begin());
  }
  return first < static_cast<std::ptrdiff_t>(recording.time_s.size()) ? static_cast<int>(first) : 0;
}

bool neverChanges(const std::vector<Recording>& recordings, const std::string& name) {
  double first = std::numeric_limits<double>::quiet_NaN();
  for (const Recording& recording : recordings) {
    const Signal* signal = recording.find(name);
    if (!signal) continue;
    for (const double value : signal->values) {
      if (!std::isfinite(value)) continue;
      if (std::isnan(first)) first = value;
      if (value != first) return false;
    }
  }
  return true;
}

std::vector<std::string> dataNotes(const std::vector<Recording>& recordings) {
  std::vector<std::string> notes;
  for (const Recording& recording : recordings) {
    std::ranges::move(dropoutNotes(recording), std::back_inserter(notes));
    std::map<std::ptrdiff_t, std::vector<std::string>> missing;  // signals by the number of rows without a value
    for (const Signal& signal : recording.signals)
      missing[std::ranges::count_if(signal.values, [](double value) { return !std::isfinite(value); })].push_back(signal.name);
    for (const auto& [count, names] : missing)
      if (count > 0)
        notes.push_back(fmt::format("{}: {} of {} rows have no number for {}; they are left out", recording.file, count,
                                    recording.time_s.size(), fmt::join(names, ", ")));
  }
  return notes;
}

bool sameCommands(const Recording& a, const Recording& b) {
  if (a.time_s != b.time_s || a.muscleCount() != b.muscleCount()) return false;
  for (int i = 0; i < a.muscleCount(); ++i) {
    const std::string name = "command_" + std::to_string(i);
    if (a.find(name)->values != b.find(name)->values) return false;
  }
  return true;
}

bool isRepeat(const Recording& a, const Recording& b) {
  const auto names = [](const Recording& one, const Recording& other) {
    return !one.info.repeat_of.empty() && one.info.repeat_of == std::filesystem::path(other.file).stem().string();
  };
  return sameCommands(a, b) || names(a, b) || names(b, a);
}

void requireDifferentMeasurements(const std::vector<Recording>& recordings) {
  const auto same = [](const Recording& a, const Recording& b) {
    bool measured = false;
    for (const Signal& signal : a.signals) {
      if (signal.name.starts_with("command_")) continue;
      const Signal* other = b.find(signal.name);
      if (!other) continue;
      measured = true;
      if (!std::ranges::equal(signal.values, other->values, [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); }))
        return false;
    }
    return measured;
  };
  for (std::size_t i = 0; i < recordings.size(); ++i)
    for (std::size_t j = i + 1; j < recordings.size(); ++j)
      if (sameCommands(recordings[i], recordings[j]) && same(recordings[i], recordings[j]))
        throw BadFile(recordings[j].file,
                      fmt::format("it holds the same numbers as {}: a repeat is a second measurement", recordings[i].file));
}

}  // namespace musclesim
