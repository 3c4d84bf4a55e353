#include "schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "../../controller/waves.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

constexpr double duration_s = 12, step_s = 0.01;
constexpr double beside = 0.5;  ///< distance between levels, in units of a command's range

/// A shape from -1 to 1 over time for each muscle, in units of half the range that its command has in the recordings.
struct ScheduleShape {
  std::string name, words;
  std::function<double(double time_s, int muscle)> shape;
};

double triangle(double time_s, double period_s) {
  return triangleWave(time_s / period_s);
}

double sign(int muscle) {
  return muscle % 2 == 0 ? 1 : -1;
}

/// Muscles with even and odd numbers move in opposition unless the schedule is a co-contraction.
const std::vector<ScheduleShape>& scheduleShapes() {
  static const std::vector<ScheduleShape> all = {
      {"slow reversals", "triangles of six seconds", [](double t, int m) { return sign(m) * triangle(t, 6); }},
      {"three speeds", "the same path in 6, 1.5 and 0.5 s",
       [](double t, int m) {
         return sign(m) * triangle(t, t < 6 ? 6 : t < 9 ? 1.5 : 0.5);
       }},
      {"steps of two sizes", "small ones, then large ones",
       [](double t, int m) { return sign(m) * (t < 6 ? 0.25 : 1) * (std::fmod(t, 3) < 1.5 ? 1 : -1); }},
      {"co-contraction", "all muscles filled and emptied together, slowly", [](double t, int) { return triangle(t, 6); }},
      {"vent and hold", "muscles with even numbers emptied for five seconds, then those with odd ones",
       [](double t, int m) { return t < 1   ? 0.0
                                    : t < 6 ? (m % 2 == 0 ? -1.0 : 1.0)
                                            : (m % 2 == 0 ? 1.0 : -1.0); }},
      {"one muscle at a time", "the muscles with even numbers for two seconds, then the others, in turn",
       [](double t, int m) { return static_cast<int>(t / 2) % 2 == m % 2 ? std::sin(std::numbers::pi * t) : 0.0; }},
  };
  return all;
}

const ScheduleShape& shapeOf(const ScheduleChoice& choice) {
  const auto found = std::ranges::find(scheduleShapes(), choice.name, &ScheduleShape::name);
  if (found == scheduleShapes().end()) throw BadParameter("schedule", choice.name, "be one that a diagnosis proposed");
  return *found;
}

struct CommandRange {
  double low = 1, high = 0;
};

/// The range of a muscle's command over all recordings, where the plant is known to operate.
CommandRange rangeOf(const std::vector<Recording>& recordings, int muscle) {
  CommandRange range;
  for (const Recording& recording : recordings)
    for (const double u : recording.find(fmt::format("command_{}", muscle))->values) {
      range.low = std::min(range.low, u);
      range.high = std::max(range.high, u);
    }
  return range;
}

}  // namespace

std::vector<ScheduleChoice> scheduleBank() {
  std::vector<ScheduleChoice> bank;
  for (const double level : {0.0, -beside, beside})
    for (const ScheduleShape& shape : scheduleShapes()) bank.push_back({shape.name, 1, level});
  return bank;
}

std::string scheduleWords(const ScheduleChoice& choice) {
  const char* level = choice.level < 0 ? ", at lower pressures than in the recordings" : choice.level > 0 ? ", at higher pressures" : "";
  return fmt::format("{} ({}){}", choice.name, shapeOf(choice).words, level);
}

Recording scheduled(const ScheduleChoice& choice, const std::vector<Recording>& recordings) {
  const ScheduleShape& shape = shapeOf(choice);
  Recording recording;
  recording.info = recordings.front().info;
  recording.info.trial = choice.name;
  for (int row = 0; row * step_s < duration_s; ++row) recording.time_s.push_back(row * step_s);
  for (int muscle = 0; muscle < recordings.front().muscleCount(); ++muscle) {
    const CommandRange range = rangeOf(recordings, muscle);
    const double size = range.high - range.low, middle = (range.low + range.high) / 2 + choice.level * size;
    Signal signal{fmt::format("command_{}", muscle), {}};
    for (const double t : recording.time_s)
      signal.values.push_back(std::clamp(middle + choice.amplitude * size / 2 * shape.shape(t, muscle), 0.0, 1.0));
    recording.signals.push_back(std::move(signal));
  }
  return recording;
}

}  // namespace musclesim
